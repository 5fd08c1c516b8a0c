// The lines that clients wrote, and when.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "coordinator/report/replay.h"

namespace tcs::report {

// How many lines and marks of a run a page holds.
inline constexpr std::size_t kMostSaidLines = 4000, kMostSaidMarks = 300;

// The line, which was there by `time_us`; none for an empty line.
[[nodiscard]] std::optional<Said> SaidOf(std::int64_t time_us, const std::string& client,
                                         const std::string& stream, std::string_view line);

// The file that a client's `stream` ("out" or "err") goes to.
[[nodiscard]] std::string SaidFile(const std::string& folder, std::string client,
                                   const std::string& stream);

// Appends the lines of a run's folder (output.csv and the clients' logs) to `replay`, in their
// order in time. Where there are more than a page should hold, of each client its earliest are
// kept.
void ReadSaid(const std::string& folder, Replay* replay);

}  // namespace tcs::report
