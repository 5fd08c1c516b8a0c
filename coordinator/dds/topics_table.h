// What `tcsim topics` prints.
#pragma once

#include <string>
#include <vector>

#include "coordinator/dds/topics_file.h"

namespace tcs::dds {

// A line per topic: type, samples, rate, drops, who writes and who reads; with `with_qos` under
// each topic a line per endpoint. Ends with a line end.
[[nodiscard]] std::string TopicsTable(const std::vector<TopicReport>& topics, bool with_qos);

// What a user of the topics will want to mend, one sentence each: readers that no writer suits, and
// samples that were dropped.
[[nodiscard]] std::vector<std::string> TopicWarnings(const std::vector<TopicReport>& topics);

}  // namespace tcs::dds
