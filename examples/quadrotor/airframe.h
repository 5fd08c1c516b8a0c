// What the programs know of the quadrotor: the numbers of quadrotor.urdf and of the rotors.
#pragma once

#include <Eigen/Core>
#include <array>

namespace quadrotor {

inline constexpr double kMassKg = 1.0;
inline const Eigen::Vector3d kInertiaKgm2{0.0053, 0.0053, 0.0102};

struct RotorPlace {
  const char* name;
  double x_m, y_m;
  double yaw;  // the way in which its drag turns the quadrotor: 1 is to the left
};
inline constexpr std::array<RotorPlace, 4> kRotors = {{{"front_left", 0.12, 0.12, 1},
                                                       {"front_right", 0.12, -0.12, -1},
                                                       {"rear_left", -0.12, 0.12, -1},
                                                       {"rear_right", -0.12, -0.12, 1}}};
inline constexpr double kThrustNs2 = 8.5e-6;  // N for each (rad/s)^2
inline constexpr double kDragNms2 = 1.4e-7;   // N m for each (rad/s)^2
inline constexpr double kMostRadps = 1000;
inline constexpr double kMostThrustN = 4 * kThrustNs2 * kMostRadps * kMostRadps;

}  // namespace quadrotor
