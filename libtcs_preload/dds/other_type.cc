#include "libtcs_preload/dds/other_type.h"

#include <dds/ddsi/ddsi_typelib.h>
#include <dds/ddsi/q_radmin.h>

#include <algorithm>
#include <cstring>
#include <utility>

namespace tcs::dds {
namespace {

struct OtherType : ddsi_sertype {
  TypeCode code;
};

struct Bytes : ddsi_serdata {
  Payload bytes;
};

const OtherType& Of(const ddsi_sertype* type) { return *static_cast<const OtherType*>(type); }
const Bytes& Of(const ddsi_serdata* sample) { return *static_cast<const Bytes*>(sample); }

Bytes* NewBytes(const ddsi_sertype* type, ddsi_serdata_kind kind, Payload bytes) {
  auto* sample = new Bytes;
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
  Payload bytes;
  bytes.reserve(size);
  for (ddsrt_msg_iovlen_t i = 0; i < count; ++i) {
    const auto* start = static_cast<const std::byte*>(pieces[i].iov_base);
    bytes.insert(bytes.end(), start, start + pieces[i].iov_len);
  }
  bytes.resize(size);
  return NewBytes(type, kind, std::move(bytes));
}

// Of what comes from a network, which is never here.
ddsi_serdata* FromFragments(const ddsi_sertype*, ddsi_serdata_kind, const nn_rdata*, std::size_t) {
  return nullptr;
}
ddsi_serdata* FromKeyHash(const ddsi_sertype*, const ddsi_keyhash*) { return nullptr; }
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
  Bytes* key = NewBytes(sample->type, SDK_KEY, {});
  key->type = nullptr;
  return key;
}

bool SameKey(const ddsi_serdata*, const ddsi_serdata*) { return true; }
void KeyHash(const ddsi_serdata*, ddsi_keyhash* hash, bool) { std::memset(hash, 0, sizeof *hash); }
void FreeBytes(ddsi_serdata* sample) { delete static_cast<Bytes*>(sample); }
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
  ops.free = FreeBytes;
  ops.print = Print;
  ops.get_keyhash = KeyHash;
  return ops;
}();

ddsi_typeid_t* TypeId(const ddsi_sertype* type, ddsi_typeid_kind_t kind) {
  ddsi_typeinfo_t* information = InformationOf(Of(type).code);
  if (information == nullptr) return nullptr;
  ddsi_typeid_t* id = ddsi_typeinfo_typeid(information, kind);
  ddsi_typeinfo_fini(information);
  dds_free(information);
  return id;
}

std::uint32_t HashOf(const ddsi_sertype* type) {
  std::uint32_t hash = 0x811c9dc5u;
  for (const std::byte byte : Of(type).code.information) {
    hash = (hash ^ static_cast<std::uint32_t>(byte)) * 0x01000193u;
  }
  return hash;
}

const ddsi_sertype_ops kTypeOperations = [] {
  ddsi_sertype_ops ops{};
  ops.version = ddsi_sertype_v0;
  ops.free = [](ddsi_sertype* type) {
    ddsi_sertype_fini(type);
    delete static_cast<OtherType*>(type);
  };
  ops.zero_samples = [](const ddsi_sertype*, void*, std::size_t) {};
  ops.realloc_samples = [](void** samples, const ddsi_sertype*, void*, std::size_t,
                           std::size_t count) { std::fill_n(samples, count, nullptr); };
  ops.free_samples = [](const ddsi_sertype*, void**, std::size_t, dds_free_op_t) {};
  ops.equal = [](const ddsi_sertype* a, const ddsi_sertype* b) { return Of(a).code == Of(b).code; };
  ops.hash = HashOf;
  ops.type_id = TypeId;
  ops.type_map = [](const ddsi_sertype* type) { return MappingOf(Of(type).code); };
  ops.type_info = [](const ddsi_sertype* type) { return InformationOf(Of(type).code); };
  return ops;
}();

// Its bytes, as long as it lives.
class Serialised {
 public:
  explicit Serialised(const ddsi_serdata* sample)
      : held_(ddsi_serdata_to_ser_ref(sample, 0, ddsi_serdata_size(sample), &bytes_)) {}
  ~Serialised() { ddsi_serdata_to_ser_unref(held_, &bytes_); }
  Serialised(const Serialised&) = delete;
  Serialised& operator=(const Serialised&) = delete;
  bool operator==(const Serialised& other) const {
    return bytes_.iov_len == other.bytes_.iov_len &&
           std::memcmp(bytes_.iov_base, other.bytes_.iov_base, bytes_.iov_len) == 0;
  }

 private:
  ddsrt_iovec_t bytes_{};
  ddsi_serdata* held_;
};

}  // namespace

ddsi_sertype* NewOtherType(const std::string& name, bool keyless, const TypeCode& code) {
  auto* type = new OtherType{};
  ddsi_sertype_init(type, name.c_str(), &kTypeOperations, &kSampleOperations, keyless);
  type->allowed_data_representation = DDS_DATA_REPRESENTATION_RESTRICT_DEFAULT;
  type->code = code;
  return type;
}

bool IsOfOtherType(const ddsi_serdata* sample) { return sample->ops == &kSampleOperations; }

bool IsSameSample(const ddsi_serdata* a, const ddsi_serdata* b) {
  if (a == b) return true;
  if (!IsOfOtherType(a) && !IsOfOtherType(b)) return false;
  return a->timestamp.v == b->timestamp.v && a->statusinfo == b->statusinfo && a->kind == b->kind &&
         ddsi_serdata_size(a) == ddsi_serdata_size(b) && Serialised(a) == Serialised(b);
}

}  // namespace tcs::dds
