// The payload of the messages about participants and endpoints (dds_exchange.h): names and QoS, as
// plain numbers and texts, so that the coordinator can read such messages and make some of its own.
//
//   kParticipant: DdsQos, then its texts.
//   kEndpoint, kTopic: DdsEndpoint, then its texts.
//
// Texts and lists lie behind the structure; a DdsBytes says where, counted from the payload's
// start. Policies have the numbers of the DDS C API's enumerations (dds_public_qosdefs.h) and, for
// kinds, of the DDS specification: 0 volatile, 1 transient local, …; durations are ns, INT64_MAX
// for ever.
//
// An endpoint's GUID belongs to its participant: the first 12 bytes are the participant's, the last
// byte says what it is (kDds…Id). When the process of a transient-local writer is told of a
// reliable transient-local reader of its topic, it must answer with what the writer has, as
// kSamples addressed to that reader, and then kHistoryEnd. The reader gets nothing of that writer
// before. The process does the same, with nothing to send, where such a writer is new and the
// reader is not.
#pragma once

#include <cstddef>
#include <cstdint>

namespace tcs::shm {

struct DdsBytes {
  std::uint32_t offset;
  std::uint32_t size;
};

// DdsQos::present: policies without their bit have DDS's default for that kind of entity.
enum DdsPolicy : std::uint32_t {
  kDdsUserData = 1u << 0,
  kDdsTopicData = 1u << 1,
  kDdsGroupData = 1u << 2,
  kDdsEntityName = 1u << 3,
  kDdsPartition = 1u << 4,
  kDdsProperties = 1u << 5,
  kDdsBinaryProperties = 1u << 6,
  kDdsDataRepresentation = 1u << 7,
  kDdsDurability = 1u << 8,
  kDdsDurabilityService = 1u << 9,
  kDdsHistory = 1u << 10,
  kDdsResourceLimits = 1u << 11,
  kDdsPresentation = 1u << 12,
  kDdsLifespan = 1u << 13,
  kDdsDeadline = 1u << 14,
  kDdsLatencyBudget = 1u << 15,
  kDdsOwnership = 1u << 16,
  kDdsOwnershipStrength = 1u << 17,
  kDdsLivelinessPolicy = 1u << 18,
  kDdsTimeBasedFilter = 1u << 19,
  kDdsReliability = 1u << 20,
  kDdsTransportPriority = 1u << 21,
  kDdsDestinationOrder = 1u << 22,
  kDdsWriterDataLifecycle = 1u << 23,
  kDdsReaderDataLifecycle = 1u << 24,
  kDdsIgnoreLocal = 1u << 25,
  kDdsTypeConsistency = 1u << 26,
};

struct DdsQos {
  std::uint32_t present;  // DdsPolicy bits
  std::int32_t durability;
  DdsBytes user_data;
  DdsBytes topic_data;
  DdsBytes group_data;
  DdsBytes entity_name;          // no zero at the end
  DdsBytes partition;            // names, a zero after each
  DdsBytes properties;           // name, zero, value, zero, name, …
  DdsBytes binary_properties;    // name, zero, the value's size as 4 bytes, value, name, …
  DdsBytes data_representation;  // std::int16_t each: 0 XCDR1, 2 XCDR2
  std::int64_t lifespan_ns;
  std::int64_t deadline_ns;
  std::int64_t latency_budget_ns;
  std::int64_t liveliness_lease_ns;
  std::int64_t time_based_filter_ns;
  std::int64_t max_blocking_ns;  // of reliability
  std::int64_t purge_no_writer_ns;
  std::int64_t purge_disposed_ns;
  std::int64_t service_cleanup_ns;
  std::int32_t service_history;
  std::int32_t service_history_depth;
  std::int32_t service_max_samples;
  std::int32_t service_max_instances;
  std::int32_t service_max_samples_per_instance;
  std::int32_t history;  // 0 keep last, 1 keep all
  std::int32_t history_depth;
  std::int32_t max_samples;  // -1 without limit, as the following
  std::int32_t max_instances;
  std::int32_t max_samples_per_instance;
  std::int32_t presentation_scope;
  std::int32_t ownership;  // 0 shared, 1 exclusive
  std::int32_t ownership_strength;
  std::int32_t liveliness;   // 0 automatic, 1 manual by participant, 2 manual by topic
  std::int32_t reliability;  // 0 best effort, 1 reliable
  std::int32_t transport_priority;
  std::int32_t destination_order;  // 0 by reception, 1 by source timestamp
  std::int32_t ignore_local;
  std::int32_t type_consistency;
  std::uint8_t coherent_access;
  std::uint8_t ordered_access;
  std::uint8_t autodispose;  // of the writer's data lifecycle
  std::uint8_t ignore_sequence_bounds;
  std::uint8_t ignore_string_bounds;
  std::uint8_t ignore_member_names;
  std::uint8_t prevent_type_widening;
  std::uint8_t force_type_validation;
  std::uint32_t reserved;
};
static_assert(sizeof(DdsQos) == 232);
static_assert(offsetof(DdsQos, lifespan_ns) == 72);
static_assert(offsetof(DdsQos, service_history) == 144);
static_assert(offsetof(DdsQos, coherent_access) == 220);

inline constexpr std::uint32_t kDdsReader = 1;
inline constexpr std::uint32_t kDdsWriter = 2;
inline constexpr std::uint32_t kDdsTopic = 3;  // in a kTopic

struct DdsEndpoint {
  std::uint32_t kind;     // kDdsReader, kDdsWriter, kDdsTopic
  std::uint32_t keyless;  // 1: the endpoint's type has no key
  DdsBytes topic;
  DdsBytes type;  // no zero at the end, as with topic
  // XTypes' TypeInformation and TypeMapping as XCDR2, little-endian; of types without them empty.
  DdsBytes type_information;
  DdsBytes type_mapping;
  DdsQos qos;
};
static_assert(sizeof(DdsEndpoint) == 272);

// The last byte of a GUID.
inline constexpr std::uint8_t kDdsParticipantId = 0xc1;  // 00 00 01 c1
inline constexpr std::uint8_t kDdsWriterWithKeyId = 0x02;
inline constexpr std::uint8_t kDdsWriterNoKeyId = 0x03;
inline constexpr std::uint8_t kDdsReaderNoKeyId = 0x04;
inline constexpr std::uint8_t kDdsReaderWithKeyId = 0x07;

}  // namespace tcs::shm
