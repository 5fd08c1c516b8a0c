// QoS as numbers and texts (shm/dds_endpoint.h), and back.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "libtcs_preload/dds/cyclone.h"
#include "libtcs_preload/dds/type_code.h"
#include "shm/dds_endpoint.h"

namespace tcs::dds {

Payload EncodeParticipant(const dds_qos_t* qos);
Payload EncodeEndpoint(std::uint32_t kind, const char* topic, const ddsi_sertype* type,
                       const dds_qos_t* qos);

struct DecodedEndpoint {
  std::uint32_t kind = 0;
  std::string topic;
  std::string type;
  bool keyless = false;
  TypeCode type_code;
};

// Empty names if the payload is malformed.
DecodedEndpoint DecodeEndpoint(const Payload& payload);

// The QoS that a payload of either kind carries; the caller deletes it.
dds_qos_t* DecodeQos(const Payload& payload, bool participant);

}  // namespace tcs::dds
