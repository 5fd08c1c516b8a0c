#include "libtcs_preload/dds/other_type.h"

#include <dds/ddsi/ddsi_typelib.h>

#include <cstring>

#include "shm/cyclone/byte_samples.h"

namespace tcs::dds {
namespace {

struct OtherType : ddsi_sertype {
  TypeCode code;
};

const OtherType& Of(const ddsi_sertype* type) { return *static_cast<const OtherType*>(type); }

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
  ddsi_sertype_ops ops = cyclone::ByteTypeOperations<OtherType>();
  ops.equal = [](const ddsi_sertype* a, const ddsi_sertype* b) { return Of(a).code == Of(b).code; };
  ops.hash = HashOf;
  ops.type_id = TypeId;
  ops.type_map = [](const ddsi_sertype* type) { return MappingOf(Of(type).code); };
  ops.type_info = [](const ddsi_sertype* type) { return InformationOf(Of(type).code); };
  return ops;
}();

// The bytes of a sample, as long as this object lives.
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
  ddsi_sertype_init(type, name.c_str(), &kTypeOperations, &cyclone::kByteSampleOperations, keyless);
  type->allowed_data_representation = DDS_DATA_REPRESENTATION_RESTRICT_DEFAULT;
  type->code = code;
  return type;
}

bool IsOfOtherType(const ddsi_serdata* sample) {
  return sample->ops == &cyclone::kByteSampleOperations;
}

bool IsSameSample(const ddsi_serdata* a, const ddsi_serdata* b) {
  if (a == b) return true;
  if (!IsOfOtherType(a) && !IsOfOtherType(b)) return false;
  return a->timestamp.v == b->timestamp.v && a->statusinfo == b->statusinfo && a->kind == b->kind &&
         ddsi_serdata_size(a) == ddsi_serdata_size(b) && Serialised(a) == Serialised(b);
}

}  // namespace tcs::dds
