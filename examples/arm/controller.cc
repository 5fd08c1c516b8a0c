// The arm's controller, 250 times a second: leads the joints along trajectories by the efforts that
// the motion takes, and by more where they are not where they should be (computed torque).
//
//   controller [PREFIX]     PREFIX: what comes before the sockets' names
//   in   arm/joints      {"joints": {NAME: {"position": rad, "velocity": rad/s}, ...}}
//        arm/trajectory  {"joints": [all, in order], "start": s, "points": [{"positions": [...],
//                        "velocities": [...], "time_from_start": s}, ...]}
//                        start: of CLOCK_MONOTONIC; until then the one before it goes on
//   out  arm/efforts     {NAME: N m, ...}
#include <deque>
#include <optional>
#include <string>

#include "examples/arm/inverse_dynamics.h"
#include "examples/arm/trajectory.h"
#include "examples/common/datagrams.h"
#include "examples/common/ticks.h"

namespace arm {

using examples::Json;
using examples::Seconds;
using examples::Socket;
using examples::Ticks;

namespace {

constexpr double kStiffness = 400, kDamping = 40;  // 1/s^2, 1/s

struct Reading {
  Joints position, velocity;
};

Reading ReadingOf(const Json& message) {
  Reading reading;
  for (int i = 0; i < kJoints; ++i) {
    const Json& joint = message.at("joints").at(kArm[static_cast<std::size_t>(i)].name);
    reading.position[i] = joint.at("position");
    reading.velocity[i] = joint.at("velocity");
  }
  return reading;
}

Joints EffortsTowards(const Motion& wanted, const Reading& is) {
  const Joints acceleration = wanted.acceleration + kStiffness * (wanted.position - is.position) +
                              kDamping * (wanted.velocity - is.velocity);
  return EffortsFor(is.position, is.velocity, acceleration);
}

void Run(const std::string& prefix) {
  Socket joints(prefix + "arm/joints"), trajectories(prefix + "arm/trajectory");
  std::deque<Trajectory> followed;  // what goes on, and what is to start later
  Ticks ticks(250);
  for (;;) {
    ticks.WaitForNext();
    while (const auto message = trajectories.Receive()) followed.emplace_back(*message);
    while (followed.size() > 1 && followed[1].start_s() <= Seconds()) followed.pop_front();
    const auto message = joints.ReceiveNewest();
    if (!message) continue;
    const Reading is = ReadingOf(*message);
    if (followed.empty()) {  // stays where it is
      followed.emplace_back(Seconds(), Points(2, {0, is.position, Joints::Zero()}));
    }
    const Joints efforts = EffortsTowards(followed.front().At(Seconds()), is);
    Json command;
    for (int i = 0; i < kJoints; ++i) {
      command[kArm[static_cast<std::size_t>(i)].name] = efforts[i];
    }
    joints.Send(prefix + "arm/efforts", command);
  }
}

}  // namespace
}  // namespace arm

int main(int argc, char** argv) { arm::Run(argc > 1 ? argv[1] : ""); }
