// Topics made by dds_create_topic_generic and dds_create_topic_arbitrary, as language bindings of
// earlier versions do: their types are sertopics, which Cyclone wraps in sertypes. They match, and
// samples arrive.
#include <dds/ddsi/ddsi_serdata.h>
#include <dds/ddsi/ddsi_sertopic.h>
#include <dds/ddsi/q_radmin.h>
#include <string.h>

#include <algorithm>

#include "tests/dds/support/process.h"
#include "tests/dds/support/samples.h"

namespace {

using namespace dds_test;

// A type without a key: one number, as little-endian CDR.
struct Cdr {
  std::uint8_t header[4] = {0x00, 0x01, 0x00, 0x00};
  std::int32_t number = 0;
};

using Serialized = ddsi_sertopic_serdata;

struct Sample : Serialized {
  Cdr cdr;
};

const Cdr& CdrOf(const Serialized* d) { return static_cast<const Sample*>(d)->cdr; }

Serialized* Make(const ddsi_sertopic* topic, ddsi_serdata_kind kind, const Cdr& cdr) {
  auto* d = new Sample;
  ddsi_sertopic_serdata_init(d, topic, kind);
  d->hash = topic->serdata_basehash;
  d->cdr = cdr;
  return d;
}

Serialized* FromFragments(const ddsi_sertopic* topic, ddsi_serdata_kind kind,
                          const nn_rdata* fragment, std::size_t size) {
  Cdr cdr;
  memcpy(&cdr, NN_RMSG_PAYLOADOFF(fragment->rmsg, NN_RDATA_PAYLOAD_OFF(fragment)),
         std::min(size, sizeof cdr));
  return Make(topic, kind, cdr);
}

Serialized* FromPieces(const ddsi_sertopic* topic, ddsi_serdata_kind kind, ddsrt_msg_iovlen_t,
                       const ddsrt_iovec_t* pieces, std::size_t size) {
  Cdr cdr;
  memcpy(&cdr, pieces[0].iov_base, std::min(size, sizeof cdr));
  return Make(topic, kind, cdr);
}

Serialized* FromSample(const ddsi_sertopic* topic, ddsi_serdata_kind kind, const void* sample) {
  Cdr cdr;
  cdr.number = *static_cast<const std::int32_t*>(sample);
  return Make(topic, kind, cdr);
}

Serialized* ToBytesInPlace(const Serialized* d, std::size_t offset, std::size_t size,
                           ddsrt_iovec_t* piece) {
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(&CdrOf(d));
  *piece = {const_cast<std::uint8_t*>(bytes + offset), size};
  return ddsi_sertopic_serdata_ref(d);
}

const ddsi_sertopic_serdata_ops kSampleOps = [] {
  ddsi_sertopic_serdata_ops ops{};
  ops.eqkey = [](const Serialized*, const Serialized*) { return true; };
  ops.get_size = [](const Serialized*) { return static_cast<std::uint32_t>(sizeof(Cdr)); };
  ops.from_ser = FromFragments;
  ops.from_ser_iov = FromPieces;
  ops.from_keyhash = [](const ddsi_sertopic* topic, const ddsi_keyhash*) {
    return Make(topic, SDK_KEY, {});
  };
  ops.from_sample = FromSample;
  ops.to_ser = [](const Serialized* d, std::size_t offset, std::size_t size, void* to) {
    memcpy(to, reinterpret_cast<const std::uint8_t*>(&CdrOf(d)) + offset, size);
  };
  ops.to_ser_ref = ToBytesInPlace;
  ops.to_ser_unref = [](Serialized* d, const ddsrt_iovec_t*) { ddsi_sertopic_serdata_unref(d); };
  ops.to_sample = [](const Serialized* d, void* sample, void**, void*) {
    *static_cast<std::int32_t*>(sample) = CdrOf(d).number;
    return true;
  };
  ops.to_topicless = [](const Serialized* d) { return ddsi_sertopic_serdata_ref(d); };
  ops.topicless_to_sample = [](const ddsi_sertopic*, const Serialized*, void*, void**, void*) {
    return true;
  };
  ops.free = [](Serialized* d) { delete static_cast<Sample*>(d); };
  ops.print = [](const ddsi_sertopic*, const Serialized*, char* to, std::size_t size) {
    if (size > 0) *to = '\0';
    return std::size_t{0};
  };
  ops.get_keyhash = [](const Serialized*, ddsi_keyhash* hash, bool) { *hash = {}; };
  return ops;
}();

const ddsi_sertopic_ops kTypeOps = [] {
  ddsi_sertopic_ops ops{};
  ops.free = [](ddsi_sertopic* topic) {
    ddsi_sertopic_fini(topic);
    delete topic;
  };
  ops.zero_samples = [](const ddsi_sertopic*, void* samples, std::size_t count) {
    memset(samples, 0, count * sizeof(std::int32_t));
  };
  ops.realloc_samples = [](void**, const ddsi_sertopic*, void*, std::size_t, std::size_t) {};
  ops.free_samples = [](const ddsi_sertopic*, void**, std::size_t, dds_free_op_t) {};
  ops.equal = [](const ddsi_sertopic*, const ddsi_sertopic*) { return true; };
  ops.hash = [](const ddsi_sertopic*) { return 0u; };
  return ops;
}();

ddsi_sertopic* NewType(const char* topic) {
  auto* type = new ddsi_sertopic{};
  ddsi_sertopic_init(type, topic, "dds_test::Number", &kTypeOps, &kSampleOps, true);
  return type;
}

#pragma GCC diagnostic ignored "-Wdeprecated-declarations"

dds_entity_t GenericTopic(const Process& self) {
  ddsi_sertopic* type = NewType("generic");
  return OK(dds_create_topic_generic(self.participant, &type, nullptr, nullptr, nullptr));
}

dds_entity_t ArbitraryTopic(const Process& self) {
  ddsi_sertopic* type = NewType("arbitrary");
  const dds_entity_t topic =
      OK(dds_create_topic_arbitrary(self.participant, type, nullptr, nullptr, nullptr));
  ddsi_sertopic_unref(type);
  return topic;
}

void Writer(Process& self) {
  const dds_entity_t writers[] = {self.Writer(GenericTopic(self)),
                                  self.Writer(ArbitraryTopic(self))};
  for (const dds_entity_t writer : writers) WaitForReaders(writer, 1);
  self.peer.Meet("matched");
  for (std::int32_t number = 1; number <= 2; number++) {
    for (const dds_entity_t writer : writers) OK(dds_write(writer, &number));
  }
  self.peer.Meet("told");
}

void Tell(const char* who, dds_entity_t reader) {
  for (int taken = 0; taken < 2; taken++) {
    WaitForState(reader, DDS_ANY_STATE);
    std::int32_t number = 0;
    void* sample = &number;
    dds_sample_info_t info;
    if (OK(dds_take(reader, &sample, &info, 1, 1)) == 1) Event("%s: %d", who, number);
  }
}

void Reader(Process& self) {
  const dds_entity_t generic = self.Reader(GenericTopic(self));
  const dds_entity_t arbitrary = self.Reader(ArbitraryTopic(self));
  for (const dds_entity_t reader : {generic, arbitrary}) WaitForWriters(reader, 1);
  self.peer.Meet("matched");
  Tell("generic", generic);
  Tell("arbitrary", arbitrary);
  self.peer.Meet("told");
}

}  // namespace

TCS_DDS_SCENARIO(generic_topics, Writer, Reader);
