// GUIDs from and to Cyclone's inner form, which is in host order; and as keys of maps.
#pragma once

#include <cstdint>
#include <cstring>
#include <functional>

#include "libtcs_preload/dds/cyclone.h"
#include "shm/dds_guid.h"

namespace tcs::dds {

static_assert(sizeof(ddsi_guid_t) == sizeof(Guid));

inline Guid GuidOf(const ddsi_guid_t& inner) {
  const ddsi_guid_t wire = nn_hton_guid(inner);
  Guid guid;
  std::memcpy(guid.data(), &wire, sizeof wire);
  return guid;
}

inline ddsi_guid_t InnerOf(const Guid& guid) {
  ddsi_guid_t wire;
  std::memcpy(&wire, guid.data(), sizeof wire);
  return nn_ntoh_guid(wire);
}

struct GuidHash {
  std::size_t operator()(const Guid& guid) const {
    std::uint64_t halves[2];
    static_assert(sizeof halves == sizeof guid);
    std::memcpy(halves, guid.data(), sizeof halves);
    return static_cast<std::size_t>(
        (halves[0] ^ (halves[1] * 0x9e3779b97f4a7c15u)) * 0xff51afd7ed558ccdu >> 8);
  }
};

}  // namespace tcs::dds
