// Finds which models are near each other, and the zones of models that are not: balls, each around
// a model, that do not overlap unless the models are in one group. While all models stay in their
// zones, no model can touch one of another group. A model that is about to leave its zone needs
// another zone, and so may models whose zones are in the way: all these models are grouped anew.
// Pure.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "simbody_bridge/model/moving_ball.h"

namespace tcs {

// Movers in a group have zones of little room, and so it is looked again soon whether they have
// parted; a mover that is alone has all the room that there is.
struct Mover {
  MovingBall around;  // around the moving shapes of a model
  int unit = 0;       // models of one unit are always one group
  int group_before = 0;
  int model = 0;
};

// A shape of a model that never moves.
struct StaticBall {
  Ball ball;
  int model = 0;
};

struct Grouping {
  std::vector<std::vector<std::size_t>> groups;  // each mover is in one
  std::vector<Ball> zones;                       // of each mover
  // Of each group, the models that are not in it and have static shapes in its zones, in order.
  std::vector<std::vector<int>> bases;
};

class Zones {
 public:
  // A model that has just got a zone cannot leave it before `horizon_s`.
  explicit Zones(double horizon_s) : horizon_s_(horizon_s) {}

  // Whether there is too little room for a zone beside `other`, the zone of a model that stays what
  // it is.
  bool IsInTheWay(const Ball& other, const Mover& mover) const;
  // `others` are zones that stay, and are in no mover's way. A static shape joins no group: it is
  // in a group's zones, or out of them.
  Grouping Group(std::span<const Mover> movers, std::span<const Ball> others,
                 std::span<const StaticBall> statics) const;

 private:
  double RoomFor(const Mover& mover) const;
  std::vector<int> BasesOf(const std::vector<std::size_t>& group, std::span<const Mover> movers,
                           std::span<const StaticBall> statics) const;

  const double horizon_s_;
};

}  // namespace tcs
