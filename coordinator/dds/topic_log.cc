#include "coordinator/dds/topic_log.h"

#include <algorithm>

#include "coordinator/dds/ros_names.h"

namespace tcs::dds {

namespace {

using shm::DdsKind;
using shm::DdsMessage;

}  // namespace

void TopicLog::Entered(const DdsMessage& header, std::span<const std::byte> payload) {
  const bool is_gone = (header.flags & shm::kDdsGone) != 0;
  if (header.kind == DdsKind::kParticipant && is_gone) ForgetAllOf(GuidAt(header.subject));
  if (header.kind == DdsKind::kEndpoint && is_gone) known_.erase(GuidAt(header.subject));
  if (header.kind == DdsKind::kEndpoint && !is_gone) NoteEndpoint(header, payload);
  if (header.kind == DdsKind::kSample) NoteSample(header, payload);
  const auto sent = DeliveryOf(header, header.to, 0);
  if (!sent.has_value()) return;
  for (DeliveryListener* listener : deliveries_) listener->Sent(*sent);
}

// The topic that the endpoint is counted with; none: there is no room for the endpoint.
std::optional<TopicLog::Topic> TopicLog::Note(const Endpoint& endpoint, int domain,
                                              Speaker speaker) {
  const std::string topic = RosTopic(endpoint.topic), type = RosType(endpoint.type);
  auto report = std::ranges::find_if(reports_, [&](const TopicReport& known) {
    return known.topic == topic && known.type == type && known.domain == domain;
  });
  const EndpointReport end{.kind = endpoint.kind,
                           .process = std::move(speaker.process),
                           .robot = std::move(speaker.robot),
                           .qos = endpoint.qos};
  const auto is_like = [&end](const EndpointReport& other) { return other.IsLike(end); };
  if (report != reports_.end()) {
    const auto like = std::ranges::find_if(report->endpoints, is_like);
    if (like != report->endpoints.end()) {
      ++like->count;
      return report - reports_.begin();
    }
  }
  if (ends_ == kMostEnds) {
    is_whole_ = false;
    return std::nullopt;
  }
  ++ends_;
  if (report == reports_.end()) {
    report = reports_.emplace(report);
    report->topic = topic;
    report->type = type;
    report->domain = domain;
  }
  report->endpoints.push_back(end);
  return report - reports_.begin();
}

// An endpoint is announced: again where its QoS changes, which is not noted.
void TopicLog::NoteEndpoint(const DdsMessage& header, std::span<const std::byte> payload) {
  const Guid guid = GuidAt(header.subject);
  if (known_.contains(guid)) return;
  const auto endpoint = DecodeEndpoint(payload);
  if (!endpoint.has_value()) return;
  const int domain = static_cast<int>(header.domain);
  const auto topic = Note(*endpoint, domain, who_(header.from));
  if (!topic.has_value()) return;
  known_[guid] = {.topic = *topic, .from = header.from, .participant = GuidAt(header.other)};
  if (listener_ != nullptr) listener_->Opened(*topic, domain, *endpoint);
}

void TopicLog::ForgetAllOf(const Guid& participant) {
  std::erase_if(known_, [&participant](const auto& known) {
    return known.second.participant == participant;
  });
}

void TopicLog::Left(std::uint32_t from) {
  std::erase_if(known_, [from](const auto& known) { return known.second.from == from; });
}

void TopicLog::NoteSample(const DdsMessage& header, std::span<const std::byte> payload) {
  const auto found = known_.find(GuidAt(header.subject));
  if (found == known_.end() || header.sample_kind != shm::kDdsData) return;
  Known& writer = found->second;
  // A sample that a late reader is sent once more; unless nobody was there when the sample was
  // written.
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

// The topic of a writer that is gone is not known any more.
std::optional<TopicLog::Delivery> TopicLog::DeliveryOf(const DdsMessage& header, std::uint32_t to,
                                                       std::int64_t at_ns) const {
  if (deliveries_.empty() || header.kind != DdsKind::kSample ||
      header.sample_kind != shm::kDdsData) {
    return std::nullopt;
  }
  const auto found = known_.find(GuidAt(header.subject));
  if (found == known_.end()) return std::nullopt;
  return Delivery{.topic = found->second.topic,
                  .from = header.from,
                  .to = to,
                  .sent_ns = header.time_ns,
                  .source_timestamp_ns = header.source_timestamp_ns,
                  .received_ns = at_ns};
}

void TopicLog::Delivered(const DdsMessage& header, std::uint32_t to, std::int64_t at_ns) {
  const auto delivery = DeliveryOf(header, to, at_ns);
  if (!delivery.has_value()) return;
  for (DeliveryListener* listener : deliveries_) listener->Delivered(*delivery);
}

void TopicLog::Dropped(const DdsMessage& header, std::uint32_t) {
  const auto found = known_.find(GuidAt(header.subject));
  if (found != known_.end()) ++reports_[found->second.topic].drops;
}

}  // namespace tcs::dds
