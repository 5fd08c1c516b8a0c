// Participants and endpoints as messages carry them: what is written comes back, what is left out
// has DDS's meaning, and what no endpoint can be is refused.
#include "coordinator/dds/endpoint_code.h"

#include <gtest/gtest.h>

#include <cstring>

#include "shm/dds_endpoint.h"

namespace tcs::dds {
namespace {

constexpr auto Ms = VirtualDuration::Milliseconds;

Endpoint Demanding(EndpointKind kind) {
  Endpoint endpoint{.kind = kind, .topic = "rt/odom", .type = "nav_msgs::msg::dds_::Odometry_"};
  endpoint.keyless = false;
  endpoint.user_data = "typehash=RIHS01_0;";
  endpoint.qos = {.reliability = Reliability::kBestEffort,
                  .history = History::kKeepAll,
                  .depth = 17,
                  .durability = Durability::kTransientLocal,
                  .liveliness = Liveliness::kManualByTopic,
                  .deadline = Ms(20),
                  .lease = Ms(300)};
  if (kind == EndpointKind::kWriter) endpoint.qos.lifespan = Ms(4000);
  return endpoint;
}

void ExpectSame(const std::optional<Endpoint>& got, const Endpoint& endpoint) {
  ASSERT_TRUE(got.has_value());
  EXPECT_EQ(got->kind, endpoint.kind);
  EXPECT_EQ(got->topic, endpoint.topic);
  EXPECT_EQ(got->type, endpoint.type);
  EXPECT_EQ(got->keyless, endpoint.keyless);
  EXPECT_EQ(got->qos, endpoint.qos);
  EXPECT_EQ(got->user_data, endpoint.user_data);
}

// What a client may say: `change` is done to an endpoint's structure.
template <class Change>
std::vector<std::byte> Changed(EndpointKind kind, const Change& change) {
  std::vector<std::byte> bytes = EncodeEndpoint(Demanding(kind));
  shm::DdsEndpoint shared;
  memcpy(&shared, bytes.data(), sizeof shared);
  change(shared);
  memcpy(bytes.data(), &shared, sizeof shared);
  return bytes;
}

TEST(EndpointCode, ComesBackAsItWas) {
  for (const EndpointKind kind : {EndpointKind::kWriter, EndpointKind::kReader}) {
    ExpectSame(DecodeEndpoint(EncodeEndpoint(Demanding(kind))), Demanding(kind));
    // ROS 2's defaults.
    const Endpoint plain{.kind = kind, .topic = "rt/a", .type = "b"};
    ExpectSame(DecodeEndpoint(EncodeEndpoint(plain)), plain);
    const Endpoint nameless{.kind = kind};
    ExpectSame(DecodeEndpoint(EncodeEndpoint(nameless)), nameless);
  }
}

// Cyclone leaves them out.
TEST(EndpointCode, PoliciesThatAreNotThereAreDdsDefaults) {
  const auto without = [](shm::DdsEndpoint& shared) { shared.qos.present = 0; };
  Qos expected;
  expected.depth = 1;
  EXPECT_EQ(DecodeEndpoint(Changed(EndpointKind::kWriter, without))->qos, expected);
  expected.reliability = Reliability::kBestEffort;
  EXPECT_EQ(DecodeEndpoint(Changed(EndpointKind::kReader, without))->qos, expected);
}

TEST(EndpointCode, NumbersThatNoPolicyHasDoNoHarm) {
  const auto got = DecodeEndpoint(Changed(EndpointKind::kWriter, [](shm::DdsEndpoint& shared) {
    shared.qos.history_depth = -5;
    shared.qos.liveliness = 77;
    shared.qos.deadline_ns = -1;
    shared.qos.lifespan_ns = 0;
    shared.qos.liveliness_lease_ns = INT64_MAX;
  }));
  ASSERT_TRUE(got.has_value());
  EXPECT_EQ(got->qos.depth, 1);
  EXPECT_EQ(got->qos.liveliness, Liveliness::kManualByTopic);
  EXPECT_EQ(got->qos.deadline, std::nullopt);
  EXPECT_EQ(got->qos.lifespan, std::nullopt);
  EXPECT_EQ(got->qos.lease, std::nullopt);
}

TEST(EndpointCode, WhatIsNoEndpointIsRefused) {
  EXPECT_FALSE(DecodeEndpoint({}).has_value());
  const std::vector<std::byte> whole = EncodeEndpoint(Demanding(EndpointKind::kReader));
  for (const std::size_t size : {sizeof(shm::DdsEndpoint) - 1, whole.size() - 1}) {
    EXPECT_FALSE(DecodeEndpoint(std::span(whole).first(size)).has_value()) << size;
  }
  const auto is_refused = [](const auto& change) {
    return !DecodeEndpoint(Changed(EndpointKind::kReader, change)).has_value();
  };
  EXPECT_TRUE(is_refused([](shm::DdsEndpoint& shared) { shared.kind = 3; }));
  EXPECT_TRUE(is_refused([](shm::DdsEndpoint& shared) { shared.topic.offset = UINT32_MAX; }));
  EXPECT_TRUE(is_refused([](shm::DdsEndpoint& shared) { shared.type.size = UINT32_MAX; }));
  EXPECT_TRUE(is_refused([](shm::DdsEndpoint& shared) { shared.type_mapping.size = 1u << 20; }));
  EXPECT_TRUE(
      is_refused([](shm::DdsEndpoint& shared) { shared.type_information.offset = 1u << 20; }));
  // Their sum begins again at 0.
  EXPECT_TRUE(is_refused([](shm::DdsEndpoint& shared) { shared.topic = {UINT32_MAX - 3, 8}; }));
}

TEST(EndpointCode, AParticipantHasANameAndUserData) {
  const std::vector<std::byte> bytes = EncodeParticipant("tcsim", "enclave=/;");
  shm::DdsQos qos;
  ASSERT_GE(bytes.size(), sizeof qos);
  memcpy(&qos, bytes.data(), sizeof qos);
  EXPECT_EQ(qos.present, shm::kDdsEntityName | shm::kDdsUserData);
  const auto text = [&bytes](shm::DdsBytes where) {
    return std::string(reinterpret_cast<const char*>(bytes.data()) + where.offset, where.size);
  };
  EXPECT_EQ(text(qos.entity_name), "tcsim");
  EXPECT_EQ(text(qos.user_data), "enclave=/;");
}

}  // namespace
}  // namespace tcs::dds
