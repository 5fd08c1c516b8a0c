#include "coordinator/gateway/raw_type.h"

#include "shm/cyclone/byte_samples.h"

namespace tcs::gateway {
namespace {

const ddsi_sertype_ops kTypeOperations = [] {
  ddsi_sertype_ops ops = cyclone::ByteTypeOperations<ddsi_sertype>();
  ops.equal = [](const ddsi_sertype*, const ddsi_sertype*) { return true; };  // but for the name
  ops.hash = [](const ddsi_sertype*) { return 0u; };
  return ops;
}();

}  // namespace

ddsi_sertype* NewRawType(const std::string& name) {
  auto* type = new ddsi_sertype{};
  ddsi_sertype_init(type, name.c_str(), &kTypeOperations, &cyclone::kByteSampleOperations, true);
  type->allowed_data_representation = DDS_DATA_REPRESENTATION_FLAG_XCDR1;
  return type;
}

ddsi_serdata* NewRawSample(const ddsi_sertype* type, std::span<const std::byte> cdr,
                           std::int64_t timestamp_ns) {
  ddsi_serdata* sample = cyclone::NewByteSample(type, SDK_DATA, {cdr.begin(), cdr.end()});
  sample->timestamp.v = timestamp_ns;
  sample->statusinfo = 0;
  return sample;
}

std::span<const std::byte> BytesOf(const ddsi_serdata* sample) {
  return cyclone::ByteSampleOf(sample).bytes;
}

}  // namespace tcs::gateway
