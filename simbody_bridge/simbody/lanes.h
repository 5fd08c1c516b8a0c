// The derivatives of many equal islands at once. An evaluation of a Simbody system costs some 5 µs
// whatever is in it and 2 µs for each free body: so islands of equal bodies are put side by side
// into one system, where they do not touch each other, and each gets to the bit what it would get
// alone.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "simbody_bridge/dynamics.h"
#include "simbody_bridge/simbody/model.h"

namespace tcs {

class SimbodyLanes {
 public:
  // Of islands that have the world's bodies of these indices, or others with the same masses.
  SimbodyLanes(const WorldSpec& world, const std::vector<int>& bodies);

  int body_count() const { return static_cast<int>(bodies_.size()); }
  // Coordinates and speeds of an island.
  std::size_t state_size() const;

  struct Lane {
    const double* state = nullptr;
    std::span<const Wrench> wrenches;
    double* rate = nullptr;  // the state's derivative; NaN where Simbody cannot tell
  };
  void Evaluate(std::span<const Lane> lanes);

 private:
  // A system of `width` islands.
  struct Row {
    std::unique_ptr<SimbodyModel> model;
    SimTK::State state;
    std::vector<Wrench> wrenches;  // in the state
  };
  Row& RowOf(std::size_t width_log2);
  void EvaluateRow(Row& row, std::span<const Lane> lanes);

  WorldSpec island_;  // a world of one island
  std::vector<int> bodies_;
  std::vector<std::unique_ptr<Row>> rows_;  // by the logarithm of their width
};

}  // namespace tcs
