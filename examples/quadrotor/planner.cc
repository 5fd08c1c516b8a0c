// Plans how the quadrotor gets to its place, again and again from where it is: of many
// trajectories, quick ones and slow ones, the quickest one that rotors and floor allow. It takes
// what time it takes.
//
//   planner NAME X Y Z [HZ]
//   in   NAME/planner_pose  as the position loop's
//   out  NAME/trajectory    (trajectory.h)
#include <algorithm>
#include <cstdio>
#include <cstdlib>
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

constexpr int kTrajectories = 400, kChecks = 400;  // points of each that are looked at
constexpr double kShortestS = 0.6, kLongestS = 4.6;
constexpr double kFloorM = 0.1;

bool IsPossible(const Trajectory& trajectory, double start_s) {
  const double start_m = trajectory.At(start_s).position_m.z();
  for (int i = 0; i <= kChecks; ++i) {
    const Motion at = trajectory.At(start_s + trajectory.length_s() * i / kChecks);
    const Vector3d thrust_n = kMassKg * (at.acceleration_mps2 + kGravity * Vector3d::UnitZ());
    if (thrust_n.norm() > 0.6 * kMostThrustN || thrust_n.z() < 0.4 * kMassKg * kGravity)
      return false;
    if (thrust_n.head<2>().norm() > 0.6 * thrust_n.z()) return false;
    if (at.position_m.z() < std::min(kFloorM, start_m)) return false;
  }
  return true;
}

std::optional<Trajectory> Plan(const Motion& from, const Vector3d& goal_m, double start_s) {
  std::optional<Trajectory> quickest;
  for (int i = kTrajectories; i-- > 0;) {
    const double length_s = kShortestS + (kLongestS - kShortestS) * i / kTrajectories;
    const Trajectory trajectory(from, goal_m, start_s, length_s);
    if (IsPossible(trajectory, start_s)) quickest = trajectory;
  }
  return quickest;
}

void Run(const std::string& name, const Vector3d& goal_m, double hz) {
  Socket pose(name + "/planner_pose");
  Ticks ticks(hz);
  for (;;) {
    ticks.WaitForNext();
    const auto reading = pose.ReceiveNewest();
    if (!reading) continue;
    const double start_s = Seconds();
    const Quaterniond attitude = QuaternionOf(reading->at("orientation"));
    const Motion from{VectorOf(reading->at("position")),
                      attitude * VectorOf(reading->at("linear_velocity")), Vector3d::Zero()};
    const auto plan = Plan(from, goal_m, start_s);
    if (plan) pose.Send(name + "/trajectory", plan->ToJson());
    std::printf("%.3f s: planned for %.1f ms, %s\n", start_s, 1e3 * (Seconds() - start_s),
                plan ? "found" : "nothing is possible");
    std::fflush(stdout);
  }
}

}  // namespace
}  // namespace quadrotor

int main(int argc, char** argv) {
  const auto number = [&](int i, double otherwise) {
    return argc > i ? std::atof(argv[i]) : otherwise;
  };
  quadrotor::Run(argc > 1 ? argv[1] : "drone", {number(2, 0), number(3, 0), number(4, 2)},
                 number(5, 50));
}
