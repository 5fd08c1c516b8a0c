// Models that are one island: how their links, joints, rotors and places are counted there.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "simbody_bridge/model/moving_ball.h"
#include "simbody_bridge/model_engine.h"

namespace tcs {

class ModelGroup {
 public:
  // `island` is the engine's index of these models' island.
  ModelGroup(const std::vector<RobotModel>& all, std::vector<int> models, int island);

  int island() const { return island_; }
  const std::vector<int>& models() const { return models_; }
  int places() const { return PlaceOfRotor(links_, joints_, rotors_); }
  bool Has(int model) const { return std::binary_search(models_.begin(), models_.end(), model); }
  // The place of `model` among the group's models.
  std::size_t MemberOf(int model) const;

  int LinkOf(std::size_t member, int link) const { return parts_[member].first_link + link; }
  int JointOf(std::size_t member, int joint) const { return parts_[member].first_joint + joint; }
  // A place of the model by itself, as the island counts it, and back.
  int PlaceIn(std::size_t member, int place) const;
  std::pair<std::size_t, int> Locate(int place) const;

  // Finds the balls that moving shapes are in, in a state of the island.
  void FindBalls(ModelEngine& engine, std::span<const double> state);
  // The balls of a member's moving shapes; of a member without moving shapes the balls of all
  // members, with which it goes.
  std::span<const MovingBall> BallsOf(std::size_t member) const {
    const Part& part = parts_[member];
    if (part.shapes == 0) return balls_;
    return std::span(balls_).subspan(part.first_shape, part.shapes);
  }

 private:
  struct Part {
    int first_link, links, first_joint, joints, first_rotor, rotors;
    std::size_t first_shape, shapes;
  };

  const std::vector<int> models_;
  const int island_;
  int links_ = 0, joints_ = 0, rotors_ = 0;
  std::vector<Part> parts_;
  std::vector<int> shape_links_;     // links with moving shapes, by the island's count
  std::vector<ShapeOnLink> shapes_;  // links count shape_links_
  std::vector<LinkState> states_;    // memory of FindBalls
  std::vector<MovingBall> balls_;
};

}  // namespace tcs
