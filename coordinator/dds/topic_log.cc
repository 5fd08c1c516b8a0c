#include "coordinator/dds/topic_log.h"

#include <algorithm>

#include "coordinator/dds/ros_names.h"

namespace tcs::dds {

namespace {

using shm::DdsKind;
using shm::DdsMessage;

}  // namespace

void TopicLog::Entered(const DdsMessage& header, std::span<const std::byte> payload) {
  if (header.kind == DdsKind::kEndpoint) NoteEndpoint(header, payload);
  if (header.kind == DdsKind::kSample) NoteSample(header, payload);
}

TopicLog::Topic TopicLog::TopicOf(const Endpoint& endpoint, int domain) {
  const std::string topic = RosTopic(endpoint.topic), type = RosType(endpoint.type);
  for (Topic i = 0; i < reports_.size(); ++i) {
    const TopicReport& report = reports_[i];
    if (report.topic == topic && report.type == type && report.domain == domain) return i;
  }
  TopicReport& report = reports_.emplace_back();
  report.topic = topic;
  report.type = type;
  report.domain = domain;
  return reports_.size() - 1;
}

// New, or gone, or with another QoS.
void TopicLog::NoteEndpoint(const DdsMessage& header, std::span<const std::byte> payload) {
  const Guid guid = GuidAt(header.subject);
  if ((header.flags & shm::kDdsGone) != 0 || known_.contains(guid)) return;
  const auto endpoint = DecodeEndpoint(payload);
  if (!endpoint.has_value()) return;
  const int domain = static_cast<int>(header.domain);
  const Topic topic = TopicOf(*endpoint, domain);
  known_[guid].topic = topic;
  Speaker speaker = who_(header.from);
  reports_[topic].endpoints.push_back({.kind = endpoint->kind,
                                       .process = std::move(speaker.process),
                                       .robot = std::move(speaker.robot),
                                       .qos = endpoint->qos});
  if (listener_ != nullptr) listener_->Opened(topic, domain, *endpoint);
}

void TopicLog::NoteSample(const DdsMessage& header, std::span<const std::byte> payload) {
  const auto found = known_.find(GuidAt(header.subject));
  if (found == known_.end() || header.sample_kind != shm::kDdsData) return;
  Known& writer = found->second;
  // What a late reader is told once more; unless nobody was there when it was written.
  if (IsAddressed(header) &&
      (header.to != shm::kDdsCoordinator || header.source_timestamp_ns <= writer.timestamp_ns)) {
    return;
  }
  const bool is_same = writer.timestamp_ns == header.source_timestamp_ns &&
                       writer.payload_size == header.payload_size &&
                       !writer.sent_to.contains(header.to);
  if (!is_same) {
    writer.timestamp_ns = header.source_timestamp_ns;
    writer.payload_size = header.payload_size;
    writer.sent_to.clear();
    reports_[writer.topic].Count(header.time_ns, payload.size());
    if (listener_ != nullptr) listener_->Written(writer.topic, header.time_ns, payload);
  }
  writer.sent_to.insert(header.to);
}

void TopicLog::Dropped(const DdsMessage& header, std::uint32_t) {
  const auto found = known_.find(GuidAt(header.subject));
  if (found != known_.end()) ++reports_[found->second.topic].drops;
}

}  // namespace tcs::dds
