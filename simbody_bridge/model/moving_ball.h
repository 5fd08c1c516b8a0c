// The balls that models' shapes are in as they move: the balls tell, without an engine, which
// models are too far apart to touch. Pure.
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

// No point of the ball is faster than `speed_mps`.
struct MovingBall {
  Ball ball;
  double speed_mps = 0;
};

// A thing that is about to touch is accelerated by no more than this, or it takes short steps
// already.
inline constexpr double kTrustedAccelerationMps2 = 20;

// The time that the way takes at least, in seconds: a fall from rest, and less for a thing that
// moves already.
double TimeOver(double way_m, double speed_mps);
// How far such a thing comes in a time.
double WayWithin(double seconds, double speed_mps);

// A shape on a link: the centre and the radius, on the link, of the ball that the shape is in.
struct ShapeOnLink {
  int link = 0;
  std::array<double, 3> center_m{};
  double reach_m = 0;
};
// The shapes that move: links that are fixed to the world have others.
std::vector<ShapeOnLink> MovingShapesOf(const RobotModel& model);
// The shapes that never move.
std::vector<StaticShape> StaticShapesOf(const RobotModel& model);
// The ball that such a shape is in.
Ball BallOf(const Shape& in_world);
MovingBall BallOf(const ShapeOnLink& shape, const LinkState& link);

// A ball around all `balls`; there is at least one.
MovingBall Around(std::span<const MovingBall> balls);

// The time for which the ball stays within `zone` at least; 0 if it is not there.
double TimeToLeave(const Ball& zone, const MovingBall& ball);

double GapBetween(const Ball& a, const Ball& b);

}  // namespace tcs
