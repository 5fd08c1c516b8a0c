// What the motors have to give for a motion: Newton's and Euler's equations, from the base to the
// tool for how everything moves, and back for what it takes (Luh, Walker and Paul, 1980).
#pragma once

#include "examples/arm/arm_model.h"

namespace arm {

// N m, with gravity and the joints' damping.
inline Joints EffortsFor(const Joints& q, const Joints& velocity, const Joints& acceleration) {
  const Frames frames = FramesAt(q);
  std::array<Vector3d, kJoints> axis, rate, turning, accelerated;  // all in the world
  Vector3d at_m = kBaseM, w = Vector3d::Zero(), dw = Vector3d::Zero(), a{0, 0, 9.81};
  for (int i = 0; i < kJoints; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const Vector3d arm_m = frames[k].at_m - at_m;
    a += dw.cross(arm_m) + w.cross(w.cross(arm_m));
    axis[k] = frames[k].turn.col(kArm[k].axis == Axis::kZ ? 2 : 1);
    dw += acceleration[i] * axis[k] + w.cross(velocity[i] * axis[k]);
    w += velocity[i] * axis[k];
    at_m = frames[k].at_m;
    rate[k] = w;
    turning[k] = dw;
    accelerated[k] = a;
  }
  Joints efforts;
  Vector3d force = Vector3d::Zero(), moment = Vector3d::Zero();  // about the joint's place
  for (int i = kJoints; i-- > 0;) {
    const auto k = static_cast<std::size_t>(i);
    if (i + 1 < kJoints) moment += (frames[k + 1].at_m - frames[k].at_m).cross(force);
    for (const Mass& mass : kMasses) {
      if (mass.joint != i) continue;
      const Vector3d arm_m = frames[k].turn * mass.centre_m;
      const Matrix3d inertia =
          frames[k].turn * mass.inertia_kgm2.asDiagonal() * frames[k].turn.transpose();
      const Vector3d push = mass.kg * (accelerated[k] + turning[k].cross(arm_m) +
                                       rate[k].cross(rate[k].cross(arm_m)));
      force += push;
      moment += arm_m.cross(push) + inertia * turning[k] + rate[k].cross(inertia * rate[k]);
    }
    efforts[i] = axis[k].dot(moment) + kArm[k].damping_nms * velocity[i];
  }
  return efforts;
}

}  // namespace arm
