// The outer loop, 50 times a second: follows the planner's trajectory by the thrust that it asks
// for.
//
//   position_loop NAME
//   in   NAME/pose        {"position": [...], "orientation": [...], "linear_velocity": [...]}
//                         the velocity along the quadrotor's own axes, as in ROS's odometry
//        NAME/trajectory  the planner's (trajectory.h)
//   out  NAME/thrust      {"thrust": [x, y, z], "yaw": rad}       N in the world
#include <algorithm>
#include <optional>
#include <string>

#include "examples/common/datagrams.h"
#include "examples/common/ticks.h"
#include "examples/quadrotor/airframe.h"
#include "examples/quadrotor/trajectory.h"
#include "examples/quadrotor/vectors.h"

namespace quadrotor {
using examples::Seconds;
using examples::Socket;
using examples::Ticks;

namespace {

constexpr double kStiffness = 6;   // 1/s^2
constexpr double kDamping = 4;     // 1/s
constexpr double kSteepest = 0.7;  // the most sideways, for each newton upwards

// The thrust for an acceleration, as far as it can be had.
Vector3d ThrustFor(const Vector3d& acceleration_mps2) {
  Vector3d thrust_n = kMassKg * (acceleration_mps2 + kGravity * Vector3d::UnitZ());
  thrust_n.z() = std::clamp(thrust_n.z(), 0.2 * kMassKg * kGravity, 0.8 * kMostThrustN);
  const double sideways = thrust_n.head<2>().norm(), most = kSteepest * thrust_n.z();
  if (sideways > most) thrust_n.head<2>() *= most / sideways;
  return thrust_n;
}

void Run(const std::string& name) {
  Socket pose(name + "/pose"), plans(name + "/trajectory");
  std::optional<Trajectory> plan;
  Ticks ticks(50);
  for (;;) {
    ticks.WaitForNext();
    if (const auto message = plans.ReceiveNewest()) plan = Trajectory(*message);
    const auto reading = pose.ReceiveNewest();
    if (!reading || !plan) continue;
    const Quaterniond attitude = QuaternionOf(reading->at("orientation"));
    const Vector3d position_m = VectorOf(reading->at("position"));
    const Vector3d velocity_mps = attitude * VectorOf(reading->at("linear_velocity"));
    const Motion wanted = plan->At(Seconds());
    const Vector3d acceleration_mps2 = wanted.acceleration_mps2 +
                                       kStiffness * (wanted.position_m - position_m) +
                                       kDamping * (wanted.velocity_mps - velocity_mps);
    pose.Send(name + "/thrust", {{"thrust", JsonOf(ThrustFor(acceleration_mps2))}, {"yaw", 0.0}});
  }
}

}  // namespace
}  // namespace quadrotor

int main(int argc, char** argv) { quadrotor::Run(argc > 1 ? argv[1] : "drone"); }
