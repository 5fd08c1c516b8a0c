// The force and the torque that act on a body at an instant.
#pragma once

#include <array>
#include <cstddef>

#include "simbody_bridge/dynamics.h"

namespace tcs {

struct Load {
  std::array<double, 3> force_n{};  // at the centre of mass
  std::array<double, 3> torque_nm{};

  bool operator==(const Load&) const = default;
};

inline Load LoadOf(const Wrench& wrench) { return {wrench.force_n, wrench.torque_nm}; }

// Adds `more`, `times` over.
inline void AddTo(Load* load, const Load& more, double times) {
  for (std::size_t i = 0; i < 3; ++i) {
    load->force_n[i] += times * more.force_n[i];
    load->torque_nm[i] += times * more.torque_nm[i];
  }
}

}  // namespace tcs
