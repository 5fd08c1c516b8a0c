// The prey's controller: reads where both bodies are, flees or wanders, and commands a force, 100
// times a second.

#include <poll.h>

#include <array>
#include <cerrno>
#include <string>
#include <system_error>

#include "examples/predator_prey/common/program.h"
#include "examples/predator_prey/prey_controller/flee_or_wander.h"
#include "examples/predator_prey/prey_controller/json_messages.h"
#include "examples/predator_prey/prey_controller/periodic_timer.h"
#include "examples/predator_prey/prey_controller/udp_socket.h"

namespace predator_prey {
namespace {

constexpr double kPeriodS = 0.01;

struct Options {
  std::string address = "127.0.0.1";
  std::uint16_t sensors_port = 0;
  std::uint16_t commands_port = 0;
  PreyOptions prey;
};

// Blocks until one of the two descriptors has something to read.
void WaitForEither(int first, int second) {
  std::array<pollfd, 2> waiting{{{.fd = first, .events = POLLIN, .revents = 0},
                                 {.fd = second, .events = POLLIN, .revents = 0}}};
  if (::poll(waiting.data(), waiting.size(), -1) < 0 && errno != EINTR) {
    throw std::system_error(errno, std::generic_category(), "cannot poll");
  }
}

void Run(const Options& options) {
  UdpSocket sensors = UdpSocket::BoundTo(options.address, options.sensors_port);
  UdpSocket commands = UdpSocket::ConnectedTo(options.address, options.commands_port);
  PeriodicTimer timer(kPeriodS);
  FleeOrWander behaviour(options.prey);
  std::optional<SensorReading> seen;

  for (;;) {
    WaitForEither(timer.fd(), sensors.fd());
    if (const auto datagram = sensors.ReceiveNewest()) {
      if (auto reading = DecodeSensorReading(*datagram)) seen = reading;
    }
    const std::uint64_t ticks = timer.TakeTicks();
    if (ticks == 0 || !seen) continue;
    const double elapsed_s = kPeriodS * static_cast<double>(ticks);
    commands.Send(
        EncodeCommand({.force_n = behaviour.Step(elapsed_s, seen->prey, seen->predator)}));
  }
}

}  // namespace
}  // namespace predator_prey

int main(int argc, char** argv) {
  using namespace predator_prey;
  Options options;
  PreyOptions& prey = options.prey;
  CommandLine command_line("Controls the prey: flees from the predator or wanders.",
                           "prey_controller");
  command_line.AddText("--address", options.address, "IPv4 address of both ports",
                       [](const std::string&) { return std::string(); });
  command_line.AddPort("--sensors-port", options.sensors_port,
                       "UDP port to receive sensor readings on");
  command_line.AddPort("--commands-port", options.commands_port,
                       "UDP port to send force commands to");
  command_line.Add("--seed", prey.seed, "seed of the random walk", Accept::kAll);
  command_line.Add("--flee-distance", prey.flee_distance_m, "flee when the predator is nearer [m]",
                   Accept::kNotNegative);
  command_line.Add("--flee-force", prey.flee_force_n, "[N]", Accept::kNotNegative);
  command_line.Add("--wander-force", prey.wander_force_n, "root mean square [N]",
                   Accept::kNotNegative);
  command_line.AddBetween("--wander-hold", prey.wander_hold_s,
                          "how long each random force is held [s]", 0.01, 1e6);
  return command_line.Run(argc, argv, [&] { Run(options); });
}
