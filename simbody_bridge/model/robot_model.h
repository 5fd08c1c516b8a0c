// A robot, or a part of one, as a tree of rigid links and joints: our own model, which files (URDF)
// are read into and from which each engine builds its system. Plain data, owned by whoever has it;
// nothing here is computed, and nothing knows an engine.
//
// Frames and units (REP-103): SI units and radians, right-handed, z up. A link's mass and shapes
// are in the link's frame; a joint's frame is the frame of its child where all of the joint's
// coordinates are 0. Effort is N m about an axis and N along one.
//
// Links and joints refer to each other by index. CheckModel (model_check.h) says what is wrong with
// a model; everything else takes models that it has passed.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "shm/virtual_time.h"
#include "simbody_bridge/model/pose.h"
#include "simbody_bridge/model/shape.h"

namespace tcs {

// As URDF means it.
struct Inertial {
  double mass_kg = 0;
  // The centre of mass, and the axes that the inertia is given in, in the link's frame.
  Pose frame;
  // The inertia about the centre of mass, along the axes of `frame`: the elements of the matrix
  // itself (ixy is minus the integral of x y dm).
  double ixx_kgm2 = 0, iyy_kgm2 = 0, izz_kgm2 = 0;
  double ixy_kgm2 = 0, ixz_kgm2 = 0, iyz_kgm2 = 0;
};

struct Link {
  std::string name;
  // None: the link is a frame without mass. A link may be that only where it does not move or is
  // fixed to a link that has mass.
  std::optional<Inertial> inertial;
  std::vector<Shape> shapes;  // for collisions
};

// A joint's coordinates and speeds, in this order:
//   kFixed       none
//   kRevolute    the angle about the axis; has limits
//   kContinuous  the angle about the axis; turns for ever
//   kPrismatic   the way along the axis; has limits
//   kPlanar      x, y and the angle about the axis: the child moves in the plane that the axis is
//                normal to. x and y are the joint frame's, turned the shortest way that takes its z
//                onto the axis; the translation comes before the rotation.
//   kFloating    coordinates: x, y, z of the child's origin and its orientation as a quaternion
//                x y z w, in the joint frame. Speeds: the velocity of the child's origin and the
//                angular velocity, both along the axes of the joint frame.
enum class JointKind { kFixed, kRevolute, kContinuous, kPrismatic, kPlanar, kFloating };

inline constexpr double kNoLimit = std::numeric_limits<double>::infinity();

// For the one coordinate of a revolute or prismatic joint; of a continuous one only effort and
// velocity.
struct JointLimits {
  double lower = -kNoLimit;  // stops that the joint cannot pass, inelastic
  double upper = kNoLimit;
  double effort = kNoLimit;    // the joint's drive gives no more
  double velocity = kNoLimit;  // for actuators and controllers: the physics do not enforce it
};

// A joint whose coordinate follows another one's: multiplier * that + offset. Both joints have one
// coordinate.
struct Mimic {
  int joint = -1;  // index into RobotModel::joints; not a joint that mimics another
  double multiplier = 1;
  double offset = 0;
};

struct Joint {
  std::string name;
  JointKind kind = JointKind::kFixed;
  int parent = -1;  // indices into RobotModel::links
  int child = -1;
  Pose origin;                          // of the joint's frame in the parent's
  std::array<double, 3> axis{1, 0, 0};  // in the joint's frame; any length but 0
  JointLimits limits;
  // Against the motion, on each speed of the joint: damping * speed, and at most `friction` as long
  // as it slides (Coulomb's).
  double damping = 0;
  double friction = 0;
  std::optional<Mimic> mimic;
  // The time constant with which the joint's drive goes over from a command to the next.
  VirtualDuration drive_lag{};
  // At the start; empty: all 0, and no rotation. A start beyond the limits is an error. A joint
  // that mimics has neither: it starts where its mimic says.
  std::vector<double> initial_position;
  std::vector<double> initial_velocity;
};

// A propeller on a link, which is not a body of its own: at the speed w it pushes with thrust w^2
// along the z of its frame, and turns its link with drag w^2 about that axis, against its own way
// round.
struct Rotor {
  std::string name;
  int link = -1;  // index into RobotModel::links
  Pose frame;     // in the link's
  double thrust_ns2 = 0;
  double drag_nms2 = 0;
  bool is_clockwise = false;        // seen from where the thrust points to
  VirtualDuration time_constant{};  // of its speed, which follows the command
  double most_radps = kNoLimit;     // the rotor turns no faster, nor backwards
};

struct RobotModel {
  std::string name;
  std::vector<Link> links;
  // Each link but the root is the child of exactly one joint.
  std::vector<Joint> joints;
  std::vector<Rotor> rotors;
  // The root: fixed to the world, or free to move in it.
  int root = 0;
  bool has_fixed_base = false;
  // The pose of the root's frame in the world, at the start; for good if the base is fixed.
  Pose at;
  std::array<double, 3> linear_velocity_mps{};  // of the root's origin; of a free base only
  std::array<double, 3> angular_velocity_radps{};
  // Links of one model pass through each other, unless this says that they collide; links that a
  // joint joins never collide.
  bool has_self_collision = false;
  // Pairs of links, by index, the lower one first, that pass through each other all the same.
  std::vector<std::pair<int, int>> ignored_pairs;
  // Whether the model collides with other models that collide with models. If not, the model
  // touches the world's fixtures alone, and is integrated by itself, whichever model is near.
  bool touches_models = true;
};

// Whether links `a` and `b` pass through each other whatever the model does otherwise.
inline bool Ignores(const RobotModel& model, int a, int b) {
  const std::pair<int, int> pair = std::minmax(a, b);
  return std::find(model.ignored_pairs.begin(), model.ignored_pairs.end(), pair) !=
         model.ignored_pairs.end();
}

// How many numbers a joint's position and velocity have.
constexpr std::size_t CoordinatesOf(JointKind kind) {
  switch (kind) {
    case JointKind::kFixed:
      return 0;
    case JointKind::kPlanar:
      return 3;
    case JointKind::kFloating:
      return 7;
    case JointKind::kRevolute:
    case JointKind::kContinuous:
    case JointKind::kPrismatic:
      break;
  }
  return 1;
}
constexpr std::size_t SpeedsOf(JointKind kind) {
  return kind == JointKind::kFloating ? 6 : CoordinatesOf(kind);
}

}  // namespace tcs
