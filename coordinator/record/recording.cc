#include "coordinator/record/recording.h"

#include "coordinator/dds/ros_names.h"
#include "coordinator/dds/type_hash.h"

namespace tcs::record {

// ROS 2's own recorder does not keep ros_discovery_info either: played back, the topic would tell
// of nodes that are gone.
bool Recording::Keeps(dds::TopicLog::Topic topic) const {
  return log_.reports()[topic].topic != dds::kDiscoveryTopic;
}

Recording::Topic& Recording::At(dds::TopicLog::Topic topic, std::string_view type_hash) {
  if (topics_.size() <= topic) topics_.resize(topic + 1);
  Topic& known = topics_[topic];
  if (known.number < 0) {
    const dds::TopicReport& report = log_.reports()[topic];
    known.number = bag_.AddTopic(report.topic, report.type, type_hash);
  }
  return known;
}

// A reader that asks for no more than DDS's least suits every writer; but only a reader that asks
// for it gets what a writer keeps for late readers.
void Recording::Opened(dds::TopicLog::Topic topic, int domain, const dds::Endpoint& endpoint) {
  if (!Keeps(topic)) return;
  const std::string hash = dds::TypeHashIn(endpoint.user_data);
  Topic& known = At(topic, hash);
  if (endpoint.kind == dds::EndpointKind::kWriter) bag_.AddOffer(known.number, endpoint.qos);
  if (known.is_read) return;
  known.is_read = true;
  dds::Endpoint reader = endpoint;
  reader.kind = dds::EndpointKind::kReader;
  // Nodes see this reader, too.
  reader.user_data = hash.empty() ? dds::UserDataOf(dds::RosType(endpoint.type), release_)
                                  : dds::UserDataWith(hash);
  reader.qos = {.reliability = dds::Reliability::kBestEffort, .history = dds::History::kKeepAll};
  if (endpoint.kind == dds::EndpointKind::kWriter &&
      endpoint.qos.durability == dds::Durability::kTransientLocal &&
      endpoint.qos.reliability == dds::Reliability::kReliable) {
    reader.qos.reliability = endpoint.qos.reliability;
    reader.qos.durability = endpoint.qos.durability;
  }
  to_read_.emplace_back(std::move(reader), domain);
}

void Recording::ReadNewTopics(std::int64_t now_ns) {
  for (const auto& [reader, domain] : std::exchange(to_read_, {})) {
    ends_.Add(reader, domain, now_ns);
  }
}

void Recording::Written(dds::TopicLog::Topic topic, std::int64_t at_ns,
                        std::span<const std::byte> cdr) {
  if (Keeps(topic)) bag_.Write(At(topic).number, at_ns + realtime_offset_ns_, cdr);
}

}  // namespace tcs::record
