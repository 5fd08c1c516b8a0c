#include "coordinator/dds/endpoint_code.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <utility>

#include "shm/dds_endpoint.h"

namespace tcs::dds {

namespace {

using shm::DdsBytes;
using shm::DdsQos;

constexpr std::int64_t kForEverNs = INT64_MAX;
// Cyclone's own value for reliable writers.
constexpr std::int64_t kMaxBlockingNs = 100'000'000;

// Texts behind a structure of `size` bytes.
class Texts {
 public:
  explicit Texts(std::size_t size) : start_(size) {}

  DdsBytes Add(std::string_view text) {
    const DdsBytes where{static_cast<std::uint32_t>(start_ + text_.size()),
                         static_cast<std::uint32_t>(text.size())};
    text_ += text;
    return where;
  }
  template <class Structure>
  std::vector<std::byte> After(const Structure& structure) const {
    std::vector<std::byte> bytes(sizeof structure + text_.size());
    memcpy(bytes.data(), &structure, sizeof structure);
    memcpy(bytes.data() + sizeof structure, text_.data(), text_.size());
    return bytes;
  }

 private:
  std::size_t start_;
  std::string text_;
};

std::int64_t NsOf(const std::optional<VirtualDuration>& duration) {
  return duration.has_value() ? duration->ns() : kForEverNs;
}

std::optional<VirtualDuration> DurationOf(std::int64_t ns) {
  if (ns <= 0 || ns == kForEverNs) return std::nullopt;
  return VirtualDuration::Nanoseconds(ns);
}

DdsQos ToShared(const Qos& qos, EndpointKind kind) {
  DdsQos shared{};
  shared.present = shm::kDdsDurability | shm::kDdsHistory | shm::kDdsReliability |
                   shm::kDdsLivelinessPolicy | shm::kDdsDeadline;
  shared.durability = qos.durability == Durability::kTransientLocal ? 1 : 0;
  shared.history = qos.history == History::kKeepAll ? 1 : 0;
  shared.history_depth = qos.depth;
  shared.reliability = qos.reliability == Reliability::kReliable ? 1 : 0;
  shared.max_blocking_ns = kMaxBlockingNs;
  shared.liveliness = static_cast<std::int32_t>(qos.liveliness);
  shared.liveliness_lease_ns = NsOf(qos.lease);
  shared.deadline_ns = NsOf(qos.deadline);
  if (kind == EndpointKind::kWriter) {
    shared.present |= shm::kDdsLifespan;
    shared.lifespan_ns = NsOf(qos.lifespan);
  }
  return shared;
}

Qos FromShared(const DdsQos& shared, EndpointKind kind) {
  const auto has = [&shared](std::uint32_t policy) { return (shared.present & policy) != 0; };
  Qos qos;
  // DDS's defaults, not ROS 2's.
  const bool reliable =
      has(shm::kDdsReliability) ? shared.reliability != 0 : kind == EndpointKind::kWriter;
  qos.reliability = reliable ? Reliability::kReliable : Reliability::kBestEffort;
  qos.depth = has(shm::kDdsHistory) ? std::max(1, shared.history_depth) : 1;
  if (has(shm::kDdsHistory) && shared.history != 0) qos.history = History::kKeepAll;
  if (has(shm::kDdsDurability) && shared.durability != 0) {
    qos.durability = Durability::kTransientLocal;
  }
  if (has(shm::kDdsLivelinessPolicy)) {
    qos.liveliness = static_cast<Liveliness>(std::clamp(shared.liveliness, 0, 2));
    qos.lease = DurationOf(shared.liveliness_lease_ns);
  }
  if (has(shm::kDdsDeadline)) qos.deadline = DurationOf(shared.deadline_ns);
  if (has(shm::kDdsLifespan)) qos.lifespan = DurationOf(shared.lifespan_ns);
  return qos;
}

bool IsInside(std::span<const std::byte> payload, DdsBytes where) {
  return where.offset <= payload.size() && where.size <= payload.size() - where.offset;
}

std::optional<std::string> TextAt(std::span<const std::byte> payload, DdsBytes where) {
  if (!IsInside(payload, where)) return std::nullopt;
  return std::string(reinterpret_cast<const char*>(payload.data()) + where.offset, where.size);
}

bool TextsAreInside(std::span<const std::byte> payload, const DdsQos& qos) {
  const std::pair<std::uint32_t, DdsBytes> texts[] = {
      {shm::kDdsUserData, qos.user_data},
      {shm::kDdsTopicData, qos.topic_data},
      {shm::kDdsGroupData, qos.group_data},
      {shm::kDdsEntityName, qos.entity_name},
      {shm::kDdsPartition, qos.partition},
      {shm::kDdsProperties, qos.properties},
      {shm::kDdsBinaryProperties, qos.binary_properties},
      {shm::kDdsDataRepresentation, qos.data_representation},
  };
  return std::ranges::all_of(texts, [&](const auto& text) {
    return (qos.present & text.first) == 0 || IsInside(payload, text.second);
  });
}

}  // namespace

std::vector<std::byte> EncodeParticipant(std::string_view name, std::string_view user_data) {
  DdsQos qos{};
  Texts texts(sizeof qos);
  qos.present = shm::kDdsEntityName | shm::kDdsUserData;
  qos.entity_name = texts.Add(name);
  qos.user_data = texts.Add(user_data);
  return texts.After(qos);
}

std::vector<std::byte> EncodeEndpoint(const Endpoint& endpoint) {
  shm::DdsEndpoint shared{};
  Texts texts(sizeof shared);
  shared.kind = endpoint.kind == EndpointKind::kWriter ? shm::kDdsWriter : shm::kDdsReader;
  shared.keyless = endpoint.keyless ? 1 : 0;
  shared.topic = texts.Add(endpoint.topic);
  shared.type = texts.Add(endpoint.type);
  shared.qos = ToShared(endpoint.qos, endpoint.kind);
  if (!endpoint.user_data.empty()) {
    shared.qos.present |= shm::kDdsUserData;
    shared.qos.user_data = texts.Add(endpoint.user_data);
  }
  return texts.After(shared);
}

namespace {

// The structure, if all texts that it refers to are there.
std::optional<shm::DdsEndpoint> SharedOf(std::span<const std::byte> payload) {
  shm::DdsEndpoint shared;
  if (payload.size() < sizeof shared) return std::nullopt;
  memcpy(&shared, payload.data(), sizeof shared);
  const bool is_whole = TextsAreInside(payload, shared.qos) && IsInside(payload, shared.topic) &&
                        IsInside(payload, shared.type) &&
                        IsInside(payload, shared.type_information) &&
                        IsInside(payload, shared.type_mapping);
  return is_whole ? std::optional(shared) : std::nullopt;
}

}  // namespace

std::optional<Endpoint> DecodeEndpoint(std::span<const std::byte> payload) {
  const std::optional<shm::DdsEndpoint> found = SharedOf(payload);
  if (!found.has_value()) return std::nullopt;
  const shm::DdsEndpoint& shared = *found;
  if (shared.kind != shm::kDdsWriter && shared.kind != shm::kDdsReader) return std::nullopt;
  auto topic = TextAt(payload, shared.topic), type = TextAt(payload, shared.type);
  if (!topic.has_value() || !type.has_value()) return std::nullopt;
  Endpoint endpoint;
  endpoint.kind = shared.kind == shm::kDdsWriter ? EndpointKind::kWriter : EndpointKind::kReader;
  endpoint.topic = std::move(*topic);
  endpoint.type = std::move(*type);
  endpoint.keyless = shared.keyless != 0;
  endpoint.qos = FromShared(shared.qos, endpoint.kind);
  if ((shared.qos.present & shm::kDdsUserData) != 0) {
    endpoint.user_data = TextAt(payload, shared.qos.user_data).value_or("");
  }
  return endpoint;
}

bool IsTopic(std::span<const std::byte> payload) {
  const std::optional<shm::DdsEndpoint> found = SharedOf(payload);
  return found.has_value() && found->kind == shm::kDdsTopic;
}

bool IsParticipant(std::span<const std::byte> payload) {
  DdsQos qos;
  if (payload.size() < sizeof qos) return false;
  memcpy(&qos, payload.data(), sizeof qos);
  return TextsAreInside(payload, qos);
}

}  // namespace tcs::dds
