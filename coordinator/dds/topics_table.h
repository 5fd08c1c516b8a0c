// The output of `tcsim topics`.
#pragma once

#include <string>
#include <vector>

#include "coordinator/dds/topics_file.h"

namespace tcs::dds {

// A line per topic: type, samples, rate, drops, who writes and who reads; with `with_qos` under
// each topic a line per endpoint. Ends with a line end.
[[nodiscard]] std::string TopicsTable(const std::vector<TopicReport>& topics, bool with_qos);

// The faults that a user of the topics will want to mend, one sentence each: readers that no writer
// suits, and samples that were dropped, and what MismatchWarnings has.
[[nodiscard]] std::vector<std::string> TopicWarnings(const std::vector<TopicReport>& topics);

// Of these, the faults that keep the two ends of a topic apart: readers that no writer suits, one
// name with two types, and ends of the simulation and of a program that are in two domains, or that
// look like one topic with two names.
[[nodiscard]] std::vector<std::string> MismatchWarnings(const std::vector<TopicReport>& topics);

}  // namespace tcs::dds
