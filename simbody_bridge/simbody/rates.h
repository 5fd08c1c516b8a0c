// The derivatives of many islands at once. An evaluation of a Simbody system costs some 5 µs
// whatever is in it and 1 to 2 µs for each free body. So islands are put side by side into one
// system, where they do not touch each other, and each gets to the bit what it would get alone.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "simbody_bridge/dynamics.h"
#include "simbody_bridge/loads.h"
#include "simbody_bridge/simbody/model.h"

namespace tcs {

class SimbodyRates {
 public:
  SimbodyRates(const WorldSpec& world, const std::vector<std::vector<int>>& islands);

  // Whether all islands are of equal bodies.
  bool has_one_kind() const { return kinds_.size() == 1; }

  // An island to evaluate, `after_s` from the beginning of its step on: its coordinates and speeds
  // then, and where their derivatives go, which are NaN where Simbody cannot tell.
  struct Lane {
    const IslandStep* step = nullptr;
    double after_s = 0;
    const double* state = nullptr;
    double* rate = nullptr;
  };
  // Changes the order of the lanes.
  void Evaluate(std::span<Lane> lanes);

 private:
  // A system of several islands, one in each slot.
  struct Row {
    std::unique_ptr<SimbodyModel> model;
    SimTK::State state;
    std::vector<Load> loads;              // in the state, of all bodies
    std::vector<std::size_t> first_body;  // of each slot
  };
  // Islands of equal bodies: each fits into any slot of their rows.
  struct Kind {
    std::vector<int> bodies;                 // of one of them
    std::vector<std::unique_ptr<Row>> rows;  // by the logarithm of their width
  };
  using Slots = std::vector<std::size_t>;

  std::unique_ptr<Row> MakeRow(const std::vector<std::vector<int>>& islands) const;
  Row& RowOf(Kind& kind, std::size_t width_log2);
  bool IsWholeCheaper(std::span<const Lane> lanes);
  void EvaluateWhole(std::span<const Lane> lanes);
  void EvaluateKind(Kind& kind, std::span<const Lane> lanes);
  bool EvaluateRow(Row& row, std::span<const Lane> lanes, const Slots& slots);
  void EvaluateAlone(const Lane& lane);
  std::size_t KindOf(const Lane& lane) const {
    return kind_of_[static_cast<std::size_t>(lane.step->island)];
  }
  Load LoadIn(const Lane& lane, std::size_t place) const;

  const WorldSpec world_;
  const Loads loads_;
  const std::vector<std::vector<int>> islands_;
  std::vector<Kind> kinds_;
  std::vector<std::size_t> kind_of_;  // of each island
  std::unique_ptr<Row> whole_;        // all islands, where there are several kinds
  Slots slots_;                       // memory of the functions above
};

}  // namespace tcs
