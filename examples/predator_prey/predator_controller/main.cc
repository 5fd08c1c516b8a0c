// The predator's controller. Over and over: (1) read the state, (2) send it to the planner, (3)
// wait for the plan, coasting, (4) execute the beginning of the plan, 100 commands a second.

#include "examples/predator_prey/common/messages.h"
#include "examples/predator_prey/common/periodic_timer.h"
#include "examples/predator_prey/common/program.h"
#include "examples/predator_prey/common/udp_socket.h"
#include "examples/predator_prey/predator_controller/plan_follower.h"
#include "examples/predator_prey/predator_controller/plan_requester.h"

namespace predator_prey {
namespace {

struct Options {
  std::uint16_t sensors_port = 0;
  std::uint16_t commands_port = 0;
  std::uint16_t planner_port = 0;
  double request_timeout_s = 3.0;
  FollowerOptions follower;
};

void Run(const Options& options) {
  UdpSocket sensors = UdpSocket::BoundTo(options.sensors_port);
  UdpSocket commands = UdpSocket::ConnectedTo(options.commands_port);
  PlanRequester planner(options.planner_port, options.request_timeout_s);
  PlanFollower follower(options.follower);
  PeriodicTimer timer(options.follower.period_s);
  std::optional<SensorReading> seen;

  for (;;) {
    WaitForAny({timer.fd(), sensors.fd(), planner.fd()});
    if (const auto datagram = sensors.ReceiveNewest()) {
      if (auto reading = DecodeSensorReading(*datagram)) seen = reading;
    }
    bool act = timer.TakeTicks() > 0;
    if (auto reply = planner.TakeReply()) {
      follower.Start(std::move(reply->steps), MonotonicSeconds());
      act = true;  // at once, not at the next tick
    }
    if (!act || !seen) continue;

    const double now_s = MonotonicSeconds();
    const std::optional<Wrench> control = follower.Control(now_s, seen->predator);
    if (!control) planner.RequestIfIdle(now_s, *seen);
    commands.Send(EncodeCommand(control.value_or(Wrench{})));
  }
}

void AddFollowerOptions(CLI::App& app, FollowerOptions& follower) {
  const auto add = [&app](const char* name, double& value, const char* help) {
    app.add_option(name, value, help)->capture_default_str()->check(CLI::NonNegativeNumber);
  };
  add("--execute", follower.execute_s, "how much of a plan is executed [s]");
  add("--kp", follower.kp_per_s2, "feedback of position [1/s²]");
  add("--kd", follower.kd_per_s, "feedback of velocity [1/s]");
  add("--mass", follower.mass_kg, "[kg]");
  add("--inertia", follower.inertia_kgm2, "[kg m²]");
  add("--max-force", follower.max_force_n, "per axis [N]");
  add("--max-torque", follower.max_torque_nm, "per axis [N m]");
}

}  // namespace
}  // namespace predator_prey

int main(int argc, char** argv) {
  using namespace predator_prey;
  Options options;
  CLI::App app("Controls the predator along the plans of predator_planner.", "predator_controller");
  AddPort(app, "--sensors-port", options.sensors_port, "UDP port to receive sensor readings on");
  AddPort(app, "--commands-port", options.commands_port, "UDP port to send wrench commands to");
  AddPort(app, "--planner-port", options.planner_port, "UDP port that the planner listens on");
  app.add_option("--request-timeout", options.request_timeout_s,
                 "ask again when a plan does not come for so long [s]")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  AddFollowerOptions(app, options.follower);
  return RunProgram(app, argc, argv, [&] { Run(options); });
}
