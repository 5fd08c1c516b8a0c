// A model as engines build it: links that are fixed to each other are one body, and each body hangs
// on the world or on another one by a joint that moves. A free base is a floating joint of the
// world. Pure.
#pragma once

#include <array>
#include <vector>

#include "simbody_bridge/model/robot_model.h"

namespace tcs {

using Matrix3 = std::array<std::array<double, 3>, 3>;

inline constexpr int kWorldBody = -1;  // as a body

struct TreeBody {
  int parent = kWorldBody;  // or another body, that comes before this one
  int joint = -1;           // of the model; -1: the joint of a free base
  JointKind kind = JointKind::kFloating;
  // The frame of the joint in the parent's frame, or in the world; where all coordinates are 0 it
  // is the body's own frame, which is that of the joint's child.
  Pose origin;
  std::array<double, 3> axis{};  // of unit length; of a floating joint none
  double mass_kg = 0;
  std::array<double, 3> center_m{};  // of mass, in the body's frame
  Matrix3 inertia_kgm2{};            // about the center of mass, along the body's axes
  // At the start, as many numbers as the joint's kind has.
  std::vector<double> position, velocity;
};

struct TreeLink {
  int body = kWorldBody;
  Pose pose;  // in the body's frame, or in the world
};

struct RigidTree {
  std::vector<TreeBody> bodies;    // parents first
  std::vector<TreeLink> links;     // of each link of the model
  std::vector<int> body_of_joint;  // of each joint of the model; of a fixed one kWorldBody
};

// A shape of a link that is fixed to the world.
struct StaticShape {
  Shape shape;   // with its pose in the world's frame
  int link = 0;  // the shape's owner
};

// `model` has passed CheckModel.
RigidTree MakeTree(const RobotModel& model);

// Mends the tree for engines: flat bodies, and sums of what CAD has rounded, are just beyond what a
// body can have, or what an engine takes for that (MuJoCo no moment below 1e-15 kg m^2).
void MakePossible(RigidTree* tree);

// The shortest way from the z axis to `axis`, of unit length.
std::array<double, 4> FromZTo(const std::array<double, 3>& axis);

}  // namespace tcs
