// topics.json of a result folder: which topics a run had, what went over them, which processes were
// at their ends.
//
// Everything in it derives from virtual time, and the order is that of the names: two runs with
// --accounting fixed write the same bytes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "coordinator/dds/qos.h"
#include "coordinator/errors/load_error.h"

namespace tcs::dds {

enum class EndpointKind { kWriter, kReader };

struct EndpointReport {
  EndpointKind kind = EndpointKind::kWriter;
  std::string process;  // the client's name, "ROBOT/CLIENT", or "tcsim"
  std::string robot;    // empty: the coordinator's
  Qos qos;
  std::int64_t count = 1;  // the number of endpoints that are the same in all of that

  bool IsLike(const EndpointReport& other) const {
    return kind == other.kind && process == other.process && robot == other.robot &&
           qos == other.qos;
  }
};

struct TopicReport {
  std::string topic, type;  // ROS 2's names where they are ROS 2's (ros_names.h)
  int domain = 0;
  std::int64_t samples = 0;                // written
  std::int64_t bytes = 0;                  // of their CDR
  std::int64_t first_ns = 0, last_ns = 0;  // the first and the last sample, in virtual time
  std::int64_t drops =
      0;  // samples that a matching reader did not get, each counted once per reader
  std::vector<EndpointReport> endpoints;  // all that there ever were, equal ones once

  // Counts a sample. Samples come in the order of virtual time.
  void Count(std::int64_t at_ns, std::size_t size) {
    if (samples++ == 0) first_ns = at_ns;
    last_ns = at_ns;
    bytes += static_cast<std::int64_t>(size);
  }
  // Samples in a second, over the time from the first to the last; 0: there is no such time.
  double RateHz() const;
};

// Empty on success, else one sentence.
[[nodiscard]] std::string WriteTopics(std::vector<TopicReport> topics, const std::string& path);

// The content of the topics.json of a result folder.
[[nodiscard]] LoadResult<std::vector<TopicReport>> ReadTopics(const std::string& folder);

}  // namespace tcs::dds
