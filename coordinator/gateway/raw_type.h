// A type for Cyclone whose samples are the bytes that they travel as: the gateway carries samples,
// and has no need to know what is in them. Without keys.
#pragma once

#include <dds/ddsi/ddsi_serdata.h>
#include <dds/ddsi/ddsi_sertype.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace tcs::gateway {

// A type of that DDS name. The caller owns it, until a topic takes it over.
[[nodiscard]] ddsi_sertype* NewRawType(const std::string& name);

// A sample of such a type: CDR with its four bytes of encapsulation. The caller owns it.
[[nodiscard]] ddsi_serdata* NewRawSample(const ddsi_sertype* type, std::span<const std::byte> cdr,
                                         std::int64_t timestamp_ns);
// The sample's bytes, valid as long as the sample lives.
[[nodiscard]] std::span<const std::byte> BytesOf(const ddsi_serdata* sample);

}  // namespace tcs::gateway
