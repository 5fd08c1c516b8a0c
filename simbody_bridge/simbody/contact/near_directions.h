// Finds which of the directions that are known are near another one, without looking at all of
// them: a mesh has thousands.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "simbody_bridge/simbody/simbody.h"

namespace tcs {

class NearDirections {
 public:
  // `near`: how far apart two unit vectors are at most that are near each other; far below 1.
  explicit NearDirections(double near) : near_(near), cell_(64 * near) {}

  // Adds a direction with the number that HasAny then asks about.
  void Add(const SimTK::Vec3& direction, std::size_t number) {
    cells_[KeyOf(CellOf(direction, 0))].push_back(number);
  }

  // Whether `is_it` holds for a direction that may be near; directions are asked about in no order.
  template <class IsIt>
  bool HasAny(const SimTK::Vec3& direction, const IsIt& is_it) const {
    // The cells that a cube around the direction reaches into: mostly one.
    const Cell low = CellOf(direction, -near_), high = CellOf(direction, near_);
    for (std::int64_t x = low[0]; x <= high[0]; ++x) {
      for (std::int64_t y = low[1]; y <= high[1]; ++y) {
        for (std::int64_t z = low[2]; z <= high[2]; ++z) {
          const auto found = cells_.find(KeyOf({x, y, z}));
          if (found == cells_.end()) continue;
          for (const std::size_t number : found->second) {
            if (is_it(number)) return true;
          }
        }
      }
    }
    return false;
  }

 private:
  using Cell = std::array<std::int64_t, 3>;

  Cell CellOf(const SimTK::Vec3& direction, double shift) const {
    Cell cell;
    for (int i = 0; i < 3; ++i) {
      cell[static_cast<std::size_t>(i)] =
          static_cast<std::int64_t>(std::floor((direction[i] + shift) / cell_));
    }
    return cell;
  }
  // The caller tells apart cells that share a key.
  static std::int64_t KeyOf(const Cell& cell) {
    return (cell[0] * 73'856'093) ^ (cell[1] * 19'349'663) ^ (cell[2] * 83'492'791);
  }

  const double near_, cell_;
  std::unordered_map<std::int64_t, std::vector<std::size_t>> cells_;
};

}  // namespace tcs
