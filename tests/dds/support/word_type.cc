#include "tests/dds/support/word_type.h"

#include <dds/ddsi/ddsi_serdata.h>
#include <dds/ddsi/ddsi_sertype.h>
#include <dds/ddsi/q_radmin.h>
#include <dds/ddsrt/heap.h>
#include <stdio.h>
#include <string.h>

#include <vector>

#include "tests/dds/support/events.h"

namespace dds_test {

namespace {

// On the wire: little-endian CDR: its header, the id, and (in data, not in keys) the text with its
// length and final zero.
constexpr std::uint8_t kHeader[4] = {0x00, 0x01, 0x00, 0x00};
constexpr std::size_t kKeySize = sizeof kHeader + sizeof(std::int32_t);

struct Serialized : ddsi_serdata {
  std::vector<std::uint8_t> bytes;  // a multiple of 4
  std::uint32_t size = 0;           // of what is meant of them

  std::int32_t Id() const {
    std::int32_t id;
    memcpy(&id, bytes.data() + sizeof kHeader, sizeof id);
    return id;
  }
};

const Serialized& Of(const ddsi_serdata* d) { return *static_cast<const Serialized*>(d); }

// Takes over the bytes.
Serialized* Make(const ddsi_sertype* type, ddsi_serdata_kind kind,
                 std::vector<std::uint8_t> bytes) {
  if (bytes.size() < kKeySize) return nullptr;
  auto* d = new Serialized;
  ddsi_serdata_init(d, type, kind);
  d->size = static_cast<std::uint32_t>(kind == SDK_KEY ? kKeySize : bytes.size());
  d->bytes = std::move(bytes);
  d->bytes.resize((d->size + 3) / 4 * 4);
  d->hash = static_cast<std::uint32_t>(d->Id()) * 2654435761u ^ type->serdata_basehash;
  return d;
}

std::vector<std::uint8_t> KeyBytes(std::int32_t id) {
  std::vector<std::uint8_t> bytes(kHeader, kHeader + sizeof kHeader);
  bytes.resize(kKeySize);
  memcpy(bytes.data() + sizeof kHeader, &id, sizeof id);
  return bytes;
}

bool SameKey(const ddsi_serdata* a, const ddsi_serdata* b) { return Of(a).Id() == Of(b).Id(); }

std::uint32_t Size(const ddsi_serdata* d) { return Of(d).size; }

ddsi_serdata* FromFragments(const ddsi_sertype* type, ddsi_serdata_kind kind,
                            const nn_rdata* fragment, std::size_t size) {
  std::vector<std::uint8_t> bytes(size);
  // They may overlap.
  for (std::size_t have = 0; fragment != nullptr; fragment = fragment->nextfrag) {
    if (fragment->maxp1 <= have) continue;
    const unsigned char* payload =
        NN_RMSG_PAYLOADOFF(fragment->rmsg, NN_RDATA_PAYLOAD_OFF(fragment));
    const std::size_t end = std::min<std::size_t>(fragment->maxp1, size);
    memcpy(bytes.data() + have, payload + (have - fragment->min), end - have);
    have = end;
  }
  return Make(type, kind, std::move(bytes));
}

ddsi_serdata* FromPieces(const ddsi_sertype* type, ddsi_serdata_kind kind, ddsrt_msg_iovlen_t count,
                         const ddsrt_iovec_t* pieces, std::size_t size) {
  std::vector<std::uint8_t> bytes;
  for (ddsrt_msg_iovlen_t i = 0; i < count; i++) {
    const auto* start = static_cast<const std::uint8_t*>(pieces[i].iov_base);
    bytes.insert(bytes.end(), start, start + pieces[i].iov_len);
  }
  bytes.resize(size);
  return Make(type, kind, std::move(bytes));
}

ddsi_serdata* FromKeyHash(const ddsi_sertype* type, const ddsi_keyhash* hash) {
  std::uint32_t big_endian;
  memcpy(&big_endian, hash->value, sizeof big_endian);
  return Make(type, SDK_KEY, KeyBytes(static_cast<std::int32_t>(__builtin_bswap32(big_endian))));
}

ddsi_serdata* FromSample(const ddsi_sertype* type, ddsi_serdata_kind kind, const void* sample) {
  const auto& word = *static_cast<const Word*>(sample);
  std::vector<std::uint8_t> bytes = KeyBytes(word.id);
  if (kind == SDK_DATA) {
    const auto length = static_cast<std::uint32_t>(word.text.size() + 1);
    bytes.resize(kKeySize + sizeof length);
    memcpy(bytes.data() + kKeySize, &length, sizeof length);
    bytes.insert(bytes.end(), word.text.c_str(), word.text.c_str() + length);
  }
  return Make(type, kind, std::move(bytes));
}

void ToBytes(const ddsi_serdata* d, std::size_t offset, std::size_t size, void* to) {
  memcpy(to, Of(d).bytes.data() + offset, size);
}

ddsi_serdata* ToBytesInPlace(const ddsi_serdata* d, std::size_t offset, std::size_t size,
                             ddsrt_iovec_t* piece) {
  piece->iov_base = const_cast<std::uint8_t*>(Of(d).bytes.data() + offset);
  piece->iov_len = size;
  return ddsi_serdata_ref(d);
}

void BytesDone(ddsi_serdata* d, const ddsrt_iovec_t*) { ddsi_serdata_unref(d); }

bool ToSample(const ddsi_serdata* d, void* sample, void**, void*) {
  auto& word = *static_cast<Word*>(sample);
  const Serialized& from = Of(d);
  word.id = from.Id();
  word.text.clear();
  if (d->kind != SDK_DATA) return true;
  std::uint32_t length;
  if (from.size < kKeySize + sizeof length) return false;
  memcpy(&length, from.bytes.data() + kKeySize, sizeof length);
  if (length == 0 || length > from.size - kKeySize - sizeof length) return false;
  word.text.assign(reinterpret_cast<const char*>(from.bytes.data() + kKeySize + sizeof length),
                   length - 1);
  return true;
}

ddsi_serdata* ToUntyped(const ddsi_serdata* d) {
  Serialized* key = Make(d->type, SDK_KEY, Of(d).bytes);
  key->type = nullptr;
  return key;
}

bool UntypedToSample(const ddsi_sertype*, const ddsi_serdata* d, void* sample, void**, void*) {
  auto& word = *static_cast<Word*>(sample);
  word.id = Of(d).Id();
  word.text.clear();
  return true;
}

void Free(ddsi_serdata* d) { delete static_cast<Serialized*>(d); }

std::size_t Print(const ddsi_sertype*, const ddsi_serdata* d, char* to, std::size_t size) {
  return static_cast<std::size_t>(snprintf(to, size, "word %d", Of(d).Id()));
}

void KeyHash(const ddsi_serdata* d, ddsi_keyhash* hash, bool) {
  const std::uint32_t big_endian = __builtin_bswap32(static_cast<std::uint32_t>(Of(d).Id()));
  memset(hash, 0, sizeof *hash);
  memcpy(hash->value, &big_endian, sizeof big_endian);
}

const ddsi_serdata_ops kDataOps = [] {
  ddsi_serdata_ops ops{};
  ops.eqkey = SameKey;
  ops.get_size = Size;
  ops.from_ser = FromFragments;
  ops.from_ser_iov = FromPieces;
  ops.from_keyhash = FromKeyHash;
  ops.from_sample = FromSample;
  ops.to_ser = ToBytes;
  ops.to_ser_ref = ToBytesInPlace;
  ops.to_ser_unref = BytesDone;
  ops.to_sample = ToSample;
  ops.to_untyped = ToUntyped;
  ops.untyped_to_sample = UntypedToSample;
  ops.free = Free;
  ops.print = Print;
  ops.get_keyhash = KeyHash;
  return ops;
}();

// Samples are C++ objects: made and destroyed as such.
void ReallocSamples(void** samples, const ddsi_sertype*, void* old, std::size_t old_count,
                    std::size_t count) {
  auto* words = new Word[count];
  auto* old_words = static_cast<Word*>(old);
  for (std::size_t i = 0; i < count; i++) {
    if (i < old_count) words[i] = std::move(old_words[i]);
    samples[i] = &words[i];
  }
  delete[] old_words;
}

void FreeSamples(const ddsi_sertype*, void** samples, std::size_t count, dds_free_op_t op) {
  if (count == 0) return;
  if (op & DDS_FREE_ALL_BIT) {
    delete[] static_cast<Word*>(samples[0]);
    return;
  }
  for (std::size_t i = 0; i < count; i++) *static_cast<Word*>(samples[i]) = Word();
}

const ddsi_sertype_ops kTypeOps = [] {
  ddsi_sertype_ops ops{};
  ops.version = ddsi_sertype_v0;
  ops.free = [](ddsi_sertype* type) {
    ddsi_sertype_fini(type);
    delete type;
  };
  ops.zero_samples = [](const ddsi_sertype*, void* samples, std::size_t count) {
    for (std::size_t i = 0; i < count; i++) static_cast<Word*>(samples)[i] = Word();
  };
  ops.realloc_samples = ReallocSamples;
  ops.free_samples = FreeSamples;
  ops.equal = [](const ddsi_sertype*, const ddsi_sertype*) { return true; };
  ops.hash = [](const ddsi_sertype*) { return 0u; };
  return ops;
}();

}  // namespace

dds_entity_t CreateWordTopic(dds_entity_t participant, const char* name) {
  ddsi_sertype* type = new ddsi_sertype{};
  ddsi_sertype_init(type, "dds_test::Word", &kTypeOps, &kDataOps, false);
  type->allowed_data_representation = DDS_DATA_REPRESENTATION_RESTRICT_DEFAULT;
  return OK(dds_create_topic_sertype(participant, name, &type, nullptr, nullptr, nullptr));
}

}  // namespace dds_test
