// The balls that models' shapes are in as they move: what tells, without an engine, which models
// are too far apart to touch. Pure.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "simbody_bridge/dynamics.h"
#include "simbody_bridge/model/rigid_tree.h"
#include "simbody_bridge/model/robot_model.h"

namespace tcs {

struct Ball {
  std::array<double, 3> center_m{};
  double radius_m = 0;
};

// None of its points is faster.
struct MovingBall {
  Ball ball;
  double speed_mps = 0;
};

// What is about to touch is accelerated by no more than this, or it takes short steps already.
inline constexpr double kTrustedAccelerationMps2 = 20;

// What the way takes at least, in seconds: a fall from rest, and what moves already less.
double TimeOver(double way_m, double speed_mps);
// How far that comes in a time.
double WayWithin(double seconds, double speed_mps);

// A shape on a link: where it is there, and of which radius the ball is that it is in.
struct ShapeOnLink {
  int link = 0;
  std::array<double, 3> center_m{};
  double reach_m = 0;
};
// Those that move: links that are fixed to the world have others.
std::vector<ShapeOnLink> MovingShapesOf(const RobotModel& model);
// Those that never do.
std::vector<StaticShape> StaticShapesOf(const RobotModel& model);
// The ball that such a shape is in.
Ball BallOf(const Shape& in_world);
MovingBall BallOf(const ShapeOnLink& shape, const LinkState& link);

// A ball around all of them; there is at least one.
MovingBall Around(std::span<const MovingBall> balls);

// At least so long the ball stays within `zone`; 0 if it is not there.
double TimeToLeave(const Ball& zone, const MovingBall& ball);

double GapBetween(const Ball& a, const Ball& b);

}  // namespace tcs
