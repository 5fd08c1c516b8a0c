// What the programs know of the arm: the numbers of arm.urdf, in metres, kilograms and radians.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cmath>

namespace arm {

using Eigen::Matrix3d;
using Eigen::Vector3d;

inline constexpr int kJoints = 6;
using Joints = Eigen::Matrix<double, kJoints, 1>;

enum class Axis { kY, kZ };

// A joint, in the frame of the link before it: that frame and its own are alike where it is at 0.
struct Joint {
  const char* name;
  Vector3d at_m;
  Axis axis;
  double most_rad, damping_nms;
};
inline const std::array<Joint, kJoints> kArm = {{{"shoulder_pan", {0, 0, 0.09}, Axis::kZ, 3.1, 2},
                                                 {"shoulder_lift", {0, 0.13, 0}, Axis::kY, 2.2, 2},
                                                 {"elbow", {0, -0.12, 0.425}, Axis::kY, 2.7, 1.5},
                                                 {"wrist_1", {0, 0, 0.392}, Axis::kY, 3.1, 0.3},
                                                 {"wrist_2", {0, 0.093, 0}, Axis::kZ, 3.1, 0.3},
                                                 {"wrist_3", {0, 0, 0.095}, Axis::kY, 6.2, 0.02}}};
// Where the arm stands in the world, and its tool in the frame of the last link.
inline const Vector3d kBaseM{0, 0, 0.5}, kToolM{0, 0.202, 0};

// What is heavy: the links and the tool, each in the frame of the link behind that joint.
struct Mass {
  int joint;
  double kg;
  Vector3d centre_m, inertia_kgm2;
};
inline const std::array<Mass, kJoints + 1> kMasses = {
    {{0, 3.7, {0, 0.03, 0}, {0.01027, 0.01027, 0.00666}},
     {1, 8.0, {0, 0, 0.2125}, {0.1265, 0.1265, 0.0121}},
     {2, 2.4, {0, 0, 0.196}, {0.03195, 0.03195, 0.00243}},
     {3, 1.2, {0, 0.0465, 0}, {0.00169, 0.00096, 0.00169}},
     {4, 1.2, {0, 0, 0.0475}, {0.00169, 0.00169, 0.00096}},
     {5, 0.25, {0, 0.041, 0}, {0.0001286, 0.0001531, 0.0001286}},
     {5, 0.35, {0, 0.142, 0}, {0.000455, 7e-05, 0.000455}}}};

// Of a link, in the world.
struct Frame {
  Matrix3d turn;
  Vector3d at_m;

  Vector3d Of(const Vector3d& point_m) const { return at_m + turn * point_m; }
};
using Frames = std::array<Frame, kJoints>;

inline Frames FramesAt(const Joints& q) {
  Frames frames;
  Frame frame{Matrix3d::Identity(), kBaseM};
  for (int i = 0; i < kJoints; ++i) {
    const auto& joint = kArm[static_cast<std::size_t>(i)];
    frame.at_m += frame.turn * joint.at_m;
    const double c = std::cos(q[i]), s = std::sin(q[i]);
    const Vector3d x = frame.turn.col(0);
    if (joint.axis == Axis::kZ) {
      const Vector3d y = frame.turn.col(1);
      frame.turn.col(0) = c * x + s * y;
      frame.turn.col(1) = c * y - s * x;
    } else {
      const Vector3d z = frame.turn.col(2);
      frame.turn.col(0) = c * x - s * z;
      frame.turn.col(2) = c * z + s * x;
    }
    frames[static_cast<std::size_t>(i)] = frame;
  }
  return frames;
}

}  // namespace arm
