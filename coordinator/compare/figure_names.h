// Names of figures as people give them.
#pragma once

#include <string>
#include <vector>

namespace tcs::compare {

// "lap_time" means all figures of that metric or client, "lap_time.last" one of them,
// "response_p50" that of all clients; a robot's name may be left out.
[[nodiscard]] bool NameMeans(const std::string& wanted, const std::string& figure);

// One of them means it.
[[nodiscard]] bool IsAmong(const std::string& figure, const std::vector<std::string>& wanted);

}  // namespace tcs::compare
