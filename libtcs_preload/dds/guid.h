// GUIDs: as messages carry them (16 bytes, network order), and as keys of maps.
#pragma once

#include <cstdint>
#include <cstring>
#include <functional>

#include "libtcs_preload/dds/cyclone.h"

namespace tcs::dds {

struct Guid {
  std::uint64_t halves[2] = {0, 0};

  bool operator==(const Guid&) const = default;
  bool IsZero() const { return halves[0] == 0 && halves[1] == 0; }

  static Guid FromBytes(const std::uint8_t* bytes) {
    Guid guid;
    std::memcpy(guid.halves, bytes, sizeof(guid.halves));
    return guid;
  }
  // From Cyclone's inner form, in host order.
  static Guid Of(const ddsi_guid_t& inner) {
    const ddsi_guid_t wire = nn_hton_guid(inner);
    Guid guid;
    std::memcpy(guid.halves, &wire, sizeof(guid.halves));
    return guid;
  }
  ddsi_guid_t Inner() const {
    ddsi_guid_t wire;
    std::memcpy(&wire, halves, sizeof(wire));
    return nn_ntoh_guid(wire);
  }
  void To(std::uint8_t* bytes) const { std::memcpy(bytes, halves, sizeof(halves)); }
};
static_assert(sizeof(ddsi_guid_t) == sizeof(Guid));

struct GuidHash {
  std::size_t operator()(const Guid& guid) const {
    return static_cast<std::size_t>(
        (guid.halves[0] ^ (guid.halves[1] * 0x9e3779b97f4a7c15u)) * 0xff51afd7ed558ccdu >> 8);
  }
};

}  // namespace tcs::dds
