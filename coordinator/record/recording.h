// A recording of all topics of a run but ros_discovery_info: a bag, and a reader of each topic, so
// that writers send what nobody else reads, too.
#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "coordinator/dds/own_endpoints.h"
#include "coordinator/dds/topic_log.h"
#include "coordinator/record/bag.h"

namespace tcs::record {

class Recording : public dds::TopicLog::Listener {
 public:
  // The log and the endpoints outlive this.
  Recording(const dds::TopicLog& log, dds::OwnEndpoints& ends, std::int64_t realtime_offset_ns,
            dds::RosRelease release)
      : log_(log), ends_(ends), realtime_offset_ns_(realtime_offset_ns), bag_(release) {}

  // Empty on success, else one sentence.
  [[nodiscard]] std::string Open(const std::string& folder) { return bag_.Open(folder); }
  [[nodiscard]] std::string Close() { return bag_.Close(); }

  // Reads the topics that have come since it was called last; not from within the hub.
  void ReadNewTopics(std::int64_t now_ns);

  void Opened(dds::TopicLog::Topic topic, int domain, const dds::Endpoint& endpoint) override;
  void Written(dds::TopicLog::Topic topic, std::int64_t at_ns,
               std::span<const std::byte> cdr) override;

 private:
  struct Topic {
    int number = -1;  // in the bag
    bool is_read = false;
  };
  bool Keeps(dds::TopicLog::Topic topic) const;
  Topic& At(dds::TopicLog::Topic topic);

  const dds::TopicLog& log_;
  dds::OwnEndpoints& ends_;
  std::int64_t realtime_offset_ns_;
  Bag bag_;
  std::vector<Topic> topics_;
  std::vector<std::pair<dds::Endpoint, int>> to_read_;  // with their domains
};

}  // namespace tcs::record
