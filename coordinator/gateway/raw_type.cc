#include "coordinator/gateway/raw_type.h"

#include <dds/ddsi/q_radmin.h>

#include <algorithm>
#include <cstring>
#include <utility>
#include <vector>

namespace tcs::gateway {
namespace {

using Bytes = std::vector<std::byte>;

struct RawSample : ddsi_serdata {
  Bytes bytes;
};

const RawSample& Of(const ddsi_serdata* sample) { return *static_cast<const RawSample*>(sample); }

RawSample* New(const ddsi_sertype* type, ddsi_serdata_kind kind, Bytes bytes) {
  auto* sample = new RawSample;
  ddsi_serdata_init(sample, type, kind);
  sample->hash = type->serdata_basehash;
  sample->bytes = std::move(bytes);
  return sample;
}

std::uint32_t Size(const ddsi_serdata* sample) {
  return static_cast<std::uint32_t>(Of(sample).bytes.size());
}

ddsi_serdata* FromPieces(const ddsi_sertype* type, ddsi_serdata_kind kind, ddsrt_msg_iovlen_t count,
                         const ddsrt_iovec_t* pieces, std::size_t size) {
  Bytes bytes;
  bytes.reserve(size);
  for (ddsrt_msg_iovlen_t i = 0; i < count; ++i) {
    const auto* start = static_cast<const std::byte*>(pieces[i].iov_base);
    bytes.insert(bytes.end(), start, start + pieces[i].iov_len);
  }
  bytes.resize(size);
  return New(type, kind, std::move(bytes));
}

// They are in order, and may overlap.
ddsi_serdata* FromFragments(const ddsi_sertype* type, ddsi_serdata_kind kind,
                            const nn_rdata* fragment, std::size_t size) {
  Bytes bytes;
  bytes.reserve(size);
  for (; fragment != nullptr; fragment = fragment->nextfrag) {
    if (fragment->maxp1 <= bytes.size()) continue;
    const auto* payload = reinterpret_cast<const std::byte*>(
        NN_RMSG_PAYLOADOFF(fragment->rmsg, NN_RDATA_PAYLOAD_OFF(fragment)));
    const std::size_t known = bytes.size() - fragment->min;
    bytes.insert(bytes.end(), payload + known, payload + (fragment->maxp1 - fragment->min));
  }
  bytes.resize(size);
  return New(type, kind, std::move(bytes));
}

ddsi_serdata* FromKeyHash(const ddsi_sertype* type, const ddsi_keyhash*) {
  return New(type, SDK_KEY, {});
}
ddsi_serdata* FromSample(const ddsi_sertype*, ddsi_serdata_kind, const void*) { return nullptr; }

void ToBytes(const ddsi_serdata* sample, std::size_t offset, std::size_t size, void* to) {
  std::memcpy(to, Of(sample).bytes.data() + offset, size);
}

ddsi_serdata* ToBytesInPlace(const ddsi_serdata* sample, std::size_t offset, std::size_t size,
                             ddsrt_iovec_t* piece) {
  piece->iov_base = const_cast<std::byte*>(Of(sample).bytes.data() + offset);
  piece->iov_len = size;
  return ddsi_serdata_ref(sample);
}
void BytesDone(ddsi_serdata* sample, const ddsrt_iovec_t*) { ddsi_serdata_unref(sample); }

bool ToSample(const ddsi_serdata*, void*, void**, void*) { return false; }
bool UntypedToSample(const ddsi_sertype*, const ddsi_serdata*, void*, void**, void*) {
  return false;
}
ddsi_serdata* ToUntyped(const ddsi_serdata* sample) {
  RawSample* untyped = New(sample->type, SDK_KEY, {});
  untyped->type = nullptr;
  return untyped;
}

bool SameKey(const ddsi_serdata*, const ddsi_serdata*) { return true; }
void KeyHash(const ddsi_serdata*, ddsi_keyhash* hash, bool) { std::memset(hash, 0, sizeof *hash); }
void Free(ddsi_serdata* sample) { delete static_cast<RawSample*>(sample); }
std::size_t Print(const ddsi_sertype*, const ddsi_serdata*, char* to, std::size_t size) {
  if (size > 0) *to = '\0';
  return 0;
}

const ddsi_serdata_ops kSampleOperations = [] {
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

const ddsi_sertype_ops kTypeOperations = [] {
  ddsi_sertype_ops ops{};
  ops.version = ddsi_sertype_v0;
  ops.free = [](ddsi_sertype* type) {
    ddsi_sertype_fini(type);
    delete type;
  };
  ops.zero_samples = [](const ddsi_sertype*, void*, std::size_t) {};
  ops.realloc_samples = [](void** samples, const ddsi_sertype*, void*, std::size_t,
                           std::size_t count) { std::fill_n(samples, count, nullptr); };
  ops.free_samples = [](const ddsi_sertype*, void**, std::size_t, dds_free_op_t) {};
  ops.equal = [](const ddsi_sertype*, const ddsi_sertype*) { return true; };  // but for the name
  ops.hash = [](const ddsi_sertype*) { return 0u; };
  return ops;
}();

}  // namespace

ddsi_sertype* NewRawType(const std::string& name) {
  auto* type = new ddsi_sertype{};
  ddsi_sertype_init(type, name.c_str(), &kTypeOperations, &kSampleOperations, true);
  type->allowed_data_representation = DDS_DATA_REPRESENTATION_FLAG_XCDR1;
  return type;
}

ddsi_serdata* NewRawSample(const ddsi_sertype* type, std::span<const std::byte> cdr,
                           std::int64_t timestamp_ns) {
  ddsi_serdata* sample = New(type, SDK_DATA, {cdr.begin(), cdr.end()});
  sample->timestamp.v = timestamp_ns;
  sample->statusinfo = 0;
  return sample;
}

std::span<const std::byte> BytesOf(const ddsi_serdata* sample) { return Of(sample).bytes; }

}  // namespace tcs::gateway
