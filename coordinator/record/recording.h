// A recording of all topics of a run but ros_discovery_info: a bag, and a reader of each topic, so
// that writers send what nobody else reads, too. The recording also has what the run tells besides:
// where bodies are, what goes over channels that are not on DDS.
#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "coordinator/dds/own_endpoints.h"
#include "coordinator/dds/topic_log.h"
#include "coordinator/record/bag.h"
#include "coordinator/record/message_sink.h"

namespace tcs::record {

class Recording final : public dds::TopicLog::Listener, public MessageSink {
 public:
  // The log and the endpoints outlive this.
  Recording(const dds::TopicLog& log, dds::OwnEndpoints& ends, std::int64_t realtime_offset_ns,
            dds::RosRelease release, StorageKind kind = StorageKind::kSqlite3)
      : log_(log),
        ends_(ends),
        realtime_offset_ns_(realtime_offset_ns),
        release_(release),
        bag_(release, kind) {}

  // Empty on success, else one sentence.
  [[nodiscard]] std::string Open(const std::string& folder) { return bag_.Open(folder); }
  // Samples that come afterwards are no part of the recording.
  [[nodiscard]] std::string Close() { return bag_.Close(); }

  // Reads the topics that have come since the last call; not to be called from within the hub.
  void ReadNewTopics(std::int64_t now_ns);

  void Opened(dds::TopicLog::Topic topic, int domain, const dds::Endpoint& endpoint) override;
  void Written(dds::TopicLog::Topic topic, std::int64_t at_ns,
               std::span<const std::byte> cdr) override;

  int AddOwnTopic(std::string_view name, std::string_view type) override {
    return bag_.AddTopic(name, type);
  }
  void WriteOwn(int topic, VirtualTime at, std::span<const std::byte> cdr) override {
    if (bag_.is_open()) bag_.Write(topic, StampOf(at), cdr);
  }
  std::int64_t StampOf(VirtualTime at) const override { return at.ns() + realtime_offset_ns_; }

 private:
  struct Topic {
    int number = -1;  // in the bag
    bool is_read = false;
  };
  bool Keeps(dds::TopicLog::Topic topic) const;
  Topic& At(dds::TopicLog::Topic topic, std::string_view type_hash = {});

  const dds::TopicLog& log_;
  dds::OwnEndpoints& ends_;
  std::int64_t realtime_offset_ns_;
  const dds::RosRelease release_;
  Bag bag_;
  std::vector<Topic> topics_;
  std::vector<std::pair<dds::Endpoint, int>> to_read_;  // with their domains
};

}  // namespace tcs::record
