// Contacts as an engine finds them, between shapes of a forest, and as Dynamics tells of them,
// between links and fixtures. Pure.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "simbody_bridge/dynamics.h"
#include "simbody_bridge/model/forest.h"

namespace tcs {

// In the world's frame.
struct ShapeContact {
  std::size_t first = 0, second = 0;  // of Forest::shapes
  std::array<double, 3> point_m{};
  std::array<double, 3> normal{};   // of unit length, from the second towards the first
  std::array<double, 3> force_n{};  // on the first
};

// Appends the contacts that push, each the way round that ContactForce has it.
void AppendForces(const Forest& forest, std::span<const ShapeContact> found,
                  std::vector<ContactForce>* contacts);

// Sorts contacts into the order of Dynamics::ReadContacts. Contacts of the same two things stay as
// they are.
void SortForces(std::vector<ContactForce>* contacts);

}  // namespace tcs
