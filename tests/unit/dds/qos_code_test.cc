// The QoS of a DDS entity survive being told to another process.
#include "libtcs_preload/dds/qos_code.h"

#include <dds/ddsi/ddsi_xqos.h>
#include <gtest/gtest.h>

#include <cstring>
#include <memory>

#include "libtcs_preload/dds/other_type.h"
#include "unknown.h"

namespace tcs::dds {
namespace {

struct DeleteQos {
  void operator()(dds_qos_t* qos) const { dds_delete_qos(qos); }
};
using Qos = std::unique_ptr<dds_qos_t, DeleteQos>;

Qos None() { return Qos(dds_create_qos()); }

// As Cyclone has those that go over a network.
void LetOthersSeeProperties(dds_qos_t* qos, bool see) {
  auto& [text, binary] = qos->property;
  for (std::uint32_t i = 0; i < text.n; ++i) text.props[i].propagate = see;
  for (std::uint32_t i = 0; i < binary.n; ++i) binary.props[i].propagate = see;
}

// Each policy, with values that are nobody's default.
Qos All() {
  Qos all = None();
  dds_qos_t* qos = all.get();
  dds_qset_userdata(qos, "user\0data", 9);
  dds_qset_topicdata(qos, "topic", 5);
  dds_qset_groupdata(qos, "", 0);
  dds_qset_entity_name(qos, "an entity");
  const char* partitions[] = {"left", "", "r*"};
  dds_qset_partition(qos, 3, partitions);
  dds_qset_prop(qos, "name", "value");
  dds_qset_prop(qos, "empty", "");
  dds_qset_bprop(qos, "bytes", "\0\1\2", 3);
  LetOthersSeeProperties(qos, true);
  const dds_data_representation_id_t representations[] = {DDS_DATA_REPRESENTATION_XCDR2,
                                                          DDS_DATA_REPRESENTATION_XCDR1};
  dds_qset_data_representation(qos, 2, representations);
  dds_qset_durability(qos, DDS_DURABILITY_TRANSIENT_LOCAL);
  dds_qset_durability_service(qos, 11, DDS_HISTORY_KEEP_LAST, 12, 13, 14, 15);
  dds_qset_history(qos, DDS_HISTORY_KEEP_LAST, 16);
  dds_qset_resource_limits(qos, 170, 18, 19);
  dds_qset_presentation(qos, DDS_PRESENTATION_TOPIC, true, true);
  dds_qset_lifespan(qos, 20);
  dds_qset_deadline(qos, 21);
  dds_qset_latency_budget(qos, 22);
  dds_qset_ownership(qos, DDS_OWNERSHIP_EXCLUSIVE);
  dds_qset_ownership_strength(qos, -23);
  dds_qset_liveliness(qos, DDS_LIVELINESS_MANUAL_BY_TOPIC, 24);
  dds_qset_time_based_filter(qos, 25);
  dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, 26);
  dds_qset_transport_priority(qos, 27);
  dds_qset_destination_order(qos, DDS_DESTINATIONORDER_BY_SOURCE_TIMESTAMP);
  dds_qset_writer_data_lifecycle(qos, false);
  dds_qset_reader_data_lifecycle(qos, 28, 29);
  dds_qset_ignorelocal(qos, DDS_IGNORELOCAL_PROCESS);
  dds_qset_type_consistency(qos, DDS_TYPE_CONSISTENCY_DISALLOW_TYPE_COERCION, true, false, true,
                            false, true);
  return all;
}

// As idlc has generated it.
TypeCode ShapeCode() {
  const auto bytes = [](const dds_type_meta_ser& meta) {
    const auto* start = reinterpret_cast<const std::byte*>(meta.data);
    return Payload(start, start + meta.sz);
  };
  return {bytes(dds_unknown_Shape_desc.type_information),
          bytes(dds_unknown_Shape_desc.type_mapping)};
}

Payload Encoded(const dds_qos_t* qos) {
  ddsi_sertype* type = NewOtherType("a::Type", true, ShapeCode());
  Payload payload = EncodeEndpoint(shm::kDdsWriter, "rt/topic", type, qos);
  ddsi_sertype_unref(type);
  return payload;
}

TEST(QosCode, KeepsAllPolicies) {
  const Qos all = All();
  const Qos back(DecodeQos(Encoded(all.get()), false));
  LetOthersSeeProperties(back.get(), true);
  EXPECT_TRUE(dds_qos_equal(all.get(), back.get()));
  const Qos of_participant(DecodeQos(EncodeParticipant(all.get()), true));
  LetOthersSeeProperties(of_participant.get(), true);
  EXPECT_TRUE(dds_qos_equal(all.get(), of_participant.get()));
}

TEST(QosCode, KeepsPropertiesOfTheProgramsOwnToItself) {
  const Qos all = All();
  LetOthersSeeProperties(all.get(), false);
  const Qos back(DecodeQos(Encoded(all.get()), false));
  std::uint32_t count = 0;
  EXPECT_FALSE(dds_qget_propnames(back.get(), &count, nullptr) && count > 0);
  EXPECT_FALSE(dds_qget_bpropnames(back.get(), &count, nullptr) && count > 0);
}

TEST(QosCode, KeepsWhatIsNotSetUnset) {
  const Qos none = None();
  const Qos back(DecodeQos(Encoded(none.get()), false));
  EXPECT_TRUE(dds_qos_equal(none.get(), back.get()));
  EXPECT_FALSE(dds_qos_equal(All().get(), back.get()));
}

TEST(QosCode, KeepsWhatTheEndpointIs) {
  const DecodedEndpoint endpoint = DecodeEndpoint(Encoded(All().get()));
  EXPECT_EQ(endpoint.kind, shm::kDdsWriter);
  EXPECT_EQ(endpoint.topic, "rt/topic");
  EXPECT_EQ(endpoint.type, "a::Type");
  EXPECT_TRUE(endpoint.keyless);
  EXPECT_EQ(endpoint.type_code, ShapeCode());
}

TEST(QosCode, TypesThatCannotBeReadAreNone) {
  const TypeCode whole = ShapeCode();
  EXPECT_EQ(Checked(whole), whole);
  EXPECT_EQ(Checked({whole.information, {}}), TypeCode{});
  for (std::size_t size = 0; size < whole.mapping.size(); ++size) {
    TypeCode cut = whole;
    cut.mapping.resize(size);
    EXPECT_EQ(Checked(cut), TypeCode{}) << size;
  }
  for (std::size_t at = 0; at < whole.information.size(); ++at) {
    TypeCode wrong = whole;
    wrong.information[at] = std::byte{0xff};
    static_cast<void>(Checked(wrong));
  }
}

TEST(QosCode, ATypeIsOneIfItsIdentifiersAre) {
  ddsi_sertype* type = NewOtherType("another::Name", true, ShapeCode());
  ddsi_sertype* without = NewOtherType("a::Type", true, {});
  EXPECT_TRUE(IsOfType(type, ShapeCode()));
  EXPECT_TRUE(IsOfType(type, {}));
  EXPECT_FALSE(IsOfType(without, ShapeCode()));
  EXPECT_EQ(CodeOf(type), ShapeCode());
  EXPECT_EQ(CodeOf(without), TypeCode{});
  ddsi_sertype_unref(type);
  ddsi_sertype_unref(without);
}

// Whatever it lacks or says: there are QoS, and what is read stays inside it.
void ExpectReadInside(const Payload& payload) {
  const DecodedEndpoint endpoint = DecodeEndpoint(payload);
  EXPECT_LE(endpoint.topic.size() + endpoint.type.size(), payload.size());
  EXPECT_NE(Qos(DecodeQos(payload, false)).get(), nullptr);
}

TEST(QosCode, SurvivesMalformedPayloads) {
  const Payload whole = Encoded(All().get());
  for (std::size_t size = 0; size < whole.size(); ++size) {
    const Payload cut(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size));
    ExpectReadInside(cut);
  }
  for (std::size_t at = 0; at + 8 <= sizeof(shm::DdsEndpoint); at += 4) {
    Payload wrong = whole;
    std::memset(wrong.data() + at, 0xff, 8);
    ExpectReadInside(wrong);
  }
}

}  // namespace
}  // namespace tcs::dds
