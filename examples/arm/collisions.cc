#include "examples/arm/collisions.h"

#include <algorithm>
#include <array>
#include <utility>

#include "examples/arm/cell.h"

namespace arm {
namespace {

constexpr double kMarginM = 0.015;  // from what stands around

// A link: what is within the radius of the line between two points, in the frame behind the joint.
struct Capsule {
  std::size_t joint;
  Vector3d from, to;
  double radius_m;
};
enum ArmPart : std::size_t {
  kShoulder,
  kUpperArm,
  kForearm,
  kWrist1,
  kWrist2,
  kWrist3,
  kCup,
  kParts
};
const std::array<Capsule, kParts> kCapsules = {{{0, {0, 0, 0}, {0, 0.12, 0}, 0.065},
                                                {1, {0, 0, 0}, {0, 0, 0.425}, 0.06},
                                                {2, {0, 0, 0}, {0, 0, 0.392}, 0.05},
                                                {3, {0, 0, 0}, {0, 0.093, 0}, 0.045},
                                                {4, {0, 0, 0}, {0, 0, 0.095}, 0.045},
                                                {5, {0, 0, 0}, {0, 0.06, 0}, 0.04},
                                                {5, {0, 0.06, 0}, {0, 0.18, 0}, 0.022}}};
// Those that could meet: neighbours cannot.
constexpr std::array<std::pair<ArmPart, ArmPart>, 9> kPairs = {{{kShoulder, kForearm},
                                                                {kShoulder, kWrist1},
                                                                {kShoulder, kWrist2},
                                                                {kShoulder, kCup},
                                                                {kUpperArm, kWrist1},
                                                                {kUpperArm, kWrist2},
                                                                {kUpperArm, kCup},
                                                                {kForearm, kWrist3},
                                                                {kForearm, kCup}}};

struct Line {
  Vector3d from, way;
  Vector3d At(double share) const { return from + share * way; }
};

double DistanceSquared(const Box& box, const Vector3d& point) {
  return (point - point.cwiseMax(box.lower).cwiseMin(box.upper)).squaredNorm();
}

// Along a line the distance from a box has one minimum, which is looked for between two points.
bool IsNear(const Line& line, const Box& box, double distance_m) {
  const double near = distance_m * distance_m;
  double low = 0, high = 1;
  for (int i = 0; i < 12; ++i) {
    const double left = low + (high - low) / 3, right = high - (high - low) / 3;
    const double at_left = DistanceSquared(box, line.At(left));
    const double at_right = DistanceSquared(box, line.At(right));
    if (std::min(at_left, at_right) < near) return true;
    (at_left < at_right ? high : low) = at_left < at_right ? right : left;
  }
  return DistanceSquared(box, line.At(low)) < near || DistanceSquared(box, line.At(high)) < near;
}

// Between two lines (Ericson, Real-Time Collision Detection, 5.1.9).
double DistanceSquared(const Line& one, const Line& other) {
  const Vector3d between = one.from - other.from;
  const double a = one.way.squaredNorm(), e = other.way.squaredNorm(), b = one.way.dot(other.way);
  const double c = one.way.dot(between), f = other.way.dot(between);
  const double denominator = a * e - b * b;
  double s = denominator > 1e-12 ? std::clamp((b * f - c * e) / denominator, 0.0, 1.0) : 0;
  double t = (b * s + f) / e;
  if (t < 0 || t > 1) {
    t = std::clamp(t, 0.0, 1.0);
    s = std::clamp((b * t - c) / a, 0.0, 1.0);
  }
  return (one.At(s) - other.At(t)).squaredNorm();
}

}  // namespace

bool IsFree(const Joints& q) {
  const Frames frames = FramesAt(q);
  std::array<Line, kParts> lines;
  for (std::size_t i = 0; i < kParts; ++i) {
    const Capsule& capsule = kCapsules[i];
    const Frame& frame = frames[capsule.joint];
    lines[i] = {frame.Of(capsule.from), frame.turn * (capsule.to - capsule.from)};
  }
  for (const auto& [one, other] : kPairs) {
    const double least = kCapsules[one].radius_m + kCapsules[other].radius_m;
    if (DistanceSquared(lines[one], lines[other]) < least * least) return false;
  }
  for (std::size_t i = 0; i < kParts; ++i) {
    for (const Box& box : kObstacles) {
      // The shoulder stands on the pedestal.
      if (i == kShoulder && &box == &kObstacles[0]) continue;
      if (IsNear(lines[i], box, kCapsules[i].radius_m + kMarginM)) return false;
    }
  }
  return true;
}

}  // namespace arm
