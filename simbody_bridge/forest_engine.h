// The common part of engines of models: a forest of models for each island, and the engine's own
// system that is built from it.
#pragma once

#include <algorithm>
#include <array>
#include <deque>
#include <span>
#include <string>
#include <vector>

#include "simbody_bridge/model/forest.h"
#include "simbody_bridge/model/moving_ball.h"
#include "simbody_bridge/model_engine.h"
#include "simbody_bridge/model_loads.h"
#include "simbody_bridge/one_line.h"

namespace tcs {

// A `System` is constructed from a forest, which outlives it, and gravity, and has start(),
// ReadLinks, ReadJoints and CopyBody.
template <class System>
class ForestEngine : public ModelEngine {
 public:
  ForestEngine(const WorldSpec& world, const std::vector<std::vector<int>>& islands)
      : models_(world.models), fixtures_(world.fixtures), gravity_mps2_(world.gravity_mps2) {
    int first_link = 0;
    for (const RobotModel& model : models_) {
      bases_.push_back(StaticShapesOf(model));
      for (StaticShape& shape : bases_.back()) shape.link += first_link;
      first_link += static_cast<int>(model.links.size());
    }
    for (const std::vector<int>& models : islands) AddIsland(models, {});
  }

  int AddIsland(const std::vector<int>& models, const std::vector<int>& bases) final {
    Forest& forest = forests_.emplace_back(MakeForest(models_, models, fixtures_));
    for (const int base : bases) AddFixtures(bases_[static_cast<std::size_t>(base)], &forest);
    try {
      systems_.emplace_back(forest, gravity_mps2_);
    } catch (const std::exception& error) {
      forests_.pop_back();
      const std::string& name = models_[static_cast<std::size_t>(models[0])].name;
      const std::size_t others = models.size() - 1;
      throw DynamicsError("model '" + name + "'" +
                          (others > 0 ? " or one of " + std::to_string(others) + " with it" : "") +
                          ": " + OnOneLine(error.what()));
    }
    loads_.emplace_back(models_, models);
    return static_cast<int>(systems_.size()) - 1;
  }

  void CopyModel(const ModelPlace& from, std::span<const double> state, const ModelPlace& to,
                 std::span<double> into) const final {
    const System& source = systems_[static_cast<std::size_t>(from.island)];
    const System& target = systems_[static_cast<std::size_t>(to.island)];
    std::size_t first = FirstBody(to);
    for (std::size_t body = FirstBody(from); IsOf(from, body); ++body) {
      source.CopyBody(body, state, target, first++, into);
    }
  }

  void ReadLinks(int island, std::span<const double> state, std::span<const int> links,
                 std::span<LinkState> read) final {
    At(island).ReadLinks(state, links, read);
  }
  void ReadJoints(int island, std::span<const double> state, const Acting& acting,
                  std::span<const int> joints, std::span<JointState> read) final {
    At(island).ReadJoints(state, LoadsOn(island).At(acting), joints, read);
  }

 protected:
  const Forest& ForestOf(int island) const { return forests_[static_cast<std::size_t>(island)]; }
  System& At(int island) { return systems_[static_cast<std::size_t>(island)]; }
  ModelLoads& LoadsOn(int island) { return loads_[static_cast<std::size_t>(island)]; }

  // For messages: the joint that moves a body of the island, by its name.
  std::string NameOfBody(int island, std::size_t body) const {
    const Forest& forest = ForestOf(island);
    if (body >= forest.bodies.size()) return {};
    const int joint = forest.bodies[body].joint;
    if (joint < 0) return "its base";
    return "joint '" + forest.joints[static_cast<std::size_t>(joint)].joint->name + "'";
  }

 private:
  bool IsOf(const ModelPlace& place, std::size_t body) const {
    const auto& models = forests_[static_cast<std::size_t>(place.island)].model_of_body;
    return body < models.size() && models[body] == place.member;
  }
  // The bodies of a model follow each other.
  std::size_t FirstBody(const ModelPlace& place) const {
    const auto& models = forests_[static_cast<std::size_t>(place.island)].model_of_body;
    return static_cast<std::size_t>(std::find(models.begin(), models.end(), place.member) -
                                    models.begin());
  }

  const std::vector<RobotModel> models_;  // which the forests point into, as into the fixtures
  const std::vector<Shape> fixtures_;
  std::vector<std::vector<StaticShape>> bases_;  // of each model, by the links of all models
  const std::array<double, 3> gravity_mps2_;
  std::deque<Forest> forests_;
  std::deque<System> systems_;
  std::deque<ModelLoads> loads_;
};

}  // namespace tcs
