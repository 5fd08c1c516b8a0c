// What engines of models have in common: a forest of models for each island, and the engine's own
// system that is built from it.
#pragma once

#include <deque>
#include <span>
#include <vector>

#include "simbody_bridge/model/forest.h"
#include "simbody_bridge/model_engine.h"

namespace tcs {

// A `System` is constructed from a forest, which outlives it, and gravity, and has start(),
// ReadLinks and ReadJoints.
template <class System>
class ForestEngine : public ModelEngine {
 public:
  ForestEngine(const WorldSpec& world, const std::vector<std::vector<int>>& islands)
      : models_(world.models), fixtures_(world.fixtures) {
    for (const std::vector<int>& models : islands) {
      forests_.push_back(MakeForest(models_, models, fixtures_));
      systems_.emplace_back(forests_.back(), world.gravity_mps2);
    }
  }

  void ReadLinks(int island, std::span<const double> state, std::span<const int> links,
                 std::span<LinkState> read) final {
    At(island).ReadLinks(state, links, read);
  }
  void ReadJoints(int island, std::span<const double> state, std::span<const Wrench> acting,
                  std::span<const int> joints, std::span<JointState> read) final {
    At(island).ReadJoints(state, acting, joints, read);
  }

 protected:
  System& At(int island) { return systems_[static_cast<std::size_t>(island)]; }

 private:
  const std::vector<RobotModel> models_;  // which the forests point into, as into the fixtures
  const std::vector<Shape> fixtures_;
  std::deque<Forest> forests_;
  std::deque<System> systems_;
};

}  // namespace tcs
