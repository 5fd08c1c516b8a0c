// The masses that make two islands of free bodies the same system.
#pragma once

#include <array>
#include <utility>
#include <vector>

#include "simbody_bridge/dynamics.h"

namespace tcs {

using Masses = std::vector<std::pair<double, std::array<double, 3>>>;

inline Masses MassesOf(const WorldSpec& world, const std::vector<int>& bodies) {
  Masses masses;
  for (const int index : bodies) {
    const BodySpec& body = world.bodies[static_cast<std::size_t>(index)];
    masses.emplace_back(body.mass_kg, body.inertia_kgm2);
  }
  return masses;
}

}  // namespace tcs
