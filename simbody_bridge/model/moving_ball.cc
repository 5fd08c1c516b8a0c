#include "simbody_bridge/model/moving_ball.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "simbody_bridge/model/vectors.h"

namespace tcs {
namespace {

double Norm(const std::array<double, 3>& v) { return std::sqrt(Dot(v, v)); }

// The radius of a ball around the origin of the shape's frame.
double ReachOf(const Geometry& geometry) {
  if (const auto* box = std::get_if<BoxShape>(&geometry)) return Norm(box->size_m) / 2;
  if (const auto* sphere = std::get_if<SphereShape>(&geometry)) return sphere->radius_m;
  if (const auto* cylinder = std::get_if<CylinderShape>(&geometry)) {
    return std::hypot(cylinder->radius_m, cylinder->length_m / 2);
  }
  if (const auto* capsule = std::get_if<CapsuleShape>(&geometry)) {
    return capsule->radius_m + capsule->length_m / 2;
  }
  double reach_m = 0;
  if (const auto* mesh = std::get_if<MeshShape>(&geometry)) {
    for (const auto& vertex : mesh->mesh->vertices_m) reach_m = std::max(reach_m, Norm(vertex));
  }
  return reach_m;  // no model has a plane
}

}  // namespace

double TimeOver(double way_m, double speed_mps) {
  if (way_m <= 0) return 0;
  return 2 * way_m /
         (speed_mps + std::sqrt(speed_mps * speed_mps + 2 * kTrustedAccelerationMps2 * way_m));
}

double WayWithin(double seconds, double speed_mps) {
  return speed_mps * seconds + kTrustedAccelerationMps2 / 2 * seconds * seconds;
}

std::vector<ShapeOnLink> MovingShapesOf(const RobotModel& model) {
  const RigidTree tree = MakeTree(model);
  std::vector<ShapeOnLink> shapes;
  for (std::size_t i = 0; i < model.links.size(); ++i) {
    if (tree.links[i].body == kWorldBody) continue;
    for (const Shape& shape : model.links[i].shapes) {
      shapes.push_back({static_cast<int>(i), shape.pose.position_m, ReachOf(shape.geometry)});
    }
  }
  return shapes;
}

std::vector<StaticShape> StaticShapesOf(const RobotModel& model) {
  const RigidTree tree = MakeTree(model);
  std::vector<StaticShape> shapes;
  for (std::size_t i = 0; i < model.links.size(); ++i) {
    if (tree.links[i].body != kWorldBody) continue;
    for (const Shape& shape : model.links[i].shapes) {
      shapes.push_back({shape, static_cast<int>(i)});
      shapes.back().shape.pose = Times(tree.links[i].pose, shape.pose);
    }
  }
  return shapes;
}

Ball BallOf(const Shape& in_world) {
  return {in_world.pose.position_m, ReachOf(in_world.geometry)};
}

MovingBall BallOf(const ShapeOnLink& shape, const LinkState& link) {
  const auto arm = Rotate(link.pose.orientation_xyzw, shape.center_m);
  const auto around = Cross(link.angular_velocity_radps, arm);
  MovingBall moving{{{}, shape.reach_m}, 0};
  std::array<double, 3> velocity_mps;
  for (std::size_t i = 0; i < 3; ++i) {
    moving.ball.center_m[i] = link.pose.position_m[i] + arm[i];
    velocity_mps[i] = link.linear_velocity_mps[i] + around[i];
  }
  moving.speed_mps = Norm(velocity_mps) + Norm(link.angular_velocity_radps) * shape.reach_m;
  return moving;
}

MovingBall Around(std::span<const MovingBall> balls) {
  MovingBall all;
  for (std::size_t i = 0; i < 3; ++i) {
    double least = std::numeric_limits<double>::infinity(), most = -least;
    for (const auto& [ball, unused] : balls) {
      least = std::min(least, ball.center_m[i] - ball.radius_m);
      most = std::max(most, ball.center_m[i] + ball.radius_m);
    }
    all.ball.center_m[i] = (least + most) / 2;
  }
  for (const MovingBall& one : balls) {
    const double far_m = Norm(Minus(one.ball.center_m, all.ball.center_m));
    all.ball.radius_m = std::max(all.ball.radius_m, far_m + one.ball.radius_m);
    all.speed_mps = std::max(all.speed_mps, one.speed_mps);
  }
  return all;
}

double GapBetween(const Ball& a, const Ball& b) {
  return Norm(Minus(a.center_m, b.center_m)) - a.radius_m - b.radius_m;
}

double TimeToLeave(const Ball& zone, const MovingBall& moving) {
  const double far_m = Norm(Minus(moving.ball.center_m, zone.center_m));
  return TimeOver(zone.radius_m - far_m - moving.ball.radius_m, moving.speed_mps);
}

}  // namespace tcs
