#include "coordinator/core/world.h"

#include <fmt/format.h>
#include <time.h>

#include <algorithm>

#include "coordinator/channel/json_codec.h"
#include "shm/layout.h"

namespace tcs {

namespace {

std::int64_t OwnCpuNs() {
  timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return t.tv_sec * 1'000'000'000 + t.tv_nsec;
}

}  // namespace

std::int64_t World::shm_never() { return shm::kNeverNs; }

std::string World::Open(const Scenario& scenario, const std::string& csv_path) {
  scenario_ = scenario;
  if (!scenario.world.has_value()) return {};
  dynamics_ = MakeSimbodyDynamics(*scenario.world);
  for (const SensorChannelSpec& spec : scenario.sensors) {
    sensors_.push_back({spec, spec.latency.ns()});
  }
  for (const CommandChannelSpec& spec : scenario.commands) {
    auto socket = UdpSocket::Bind(spec.listen);
    if (auto* error = std::get_if<SocketError>(&socket)) return error->message;
    command_sockets_.push_back(std::move(std::get<UdpSocket>(socket)));
    command_fds_.push_back(command_sockets_.back().fd());
  }
  auto out = UdpSocket::ForSending();
  if (auto* error = std::get_if<SocketError>(&out)) return error->message;
  out_.emplace(std::move(std::get<UdpSocket>(out)));
  if (!csv_path.empty()) {
    csv_.open(csv_path);
    csv_ << "time_s,body,x_m,y_m,z_m,qx,qy,qz,qw,vx_mps,vy_mps,vz_mps,wx_radps,wy_radps,wz_radps\n";
  }
  return {};
}

std::int64_t World::NextOutputNs() const {
  std::int64_t next = shm::kNeverNs;
  for (const Sensor& sensor : sensors_) next = std::min(next, sensor.next_ns);
  return next;
}

void World::WriteCsv() {
  const std::int64_t now = progress_ns();
  if (!csv_.is_open() || now < next_csv_ns_) return;
  next_csv_ns_ += scenario_.csv_period.ns();
  for (std::size_t i = 0; i < scenario_.world->bodies.size(); ++i) {
    const BodyState s = dynamics_->Read(static_cast<int>(i));
    csv_ << fmt::format("{:.9f},{},{},{},{},{}\n", static_cast<double>(now) * 1e-9,
                        scenario_.world->bodies[i].name, fmt::join(s.position_m, ","),
                        fmt::join(s.orientation_xyzw, ","), fmt::join(s.linear_velocity_mps, ","),
                        fmt::join(s.angular_velocity_radps, ","));
  }
}

bool World::Advance(std::int64_t limit_ns) {
  const std::int64_t start = OwnCpuNs();
  std::int64_t to = std::min(limit_ns, NextOutputNs());
  if (csv_.is_open() && next_csv_ns_ >= progress_ns()) to = std::min(to, next_csv_ns_);
  dynamics_->AdvanceTo(VirtualTime::FromNanoseconds(std::max(to, progress_ns())));
  WriteCsv();
  bool sent = false;
  for (Sensor& sensor : sensors_) {
    if (sensor.next_ns > progress_ns()) continue;
    // With a latency the datagram is late, not the sample's contents: a known simplification.
    std::vector<NamedBodyState> states;
    for (const int body : sensor.spec.bodies) {
      const auto i = static_cast<std::size_t>(body);
      states.push_back({scenario_.world->bodies[i].name, dynamics_->Read(body)});
    }
    // A full or absent receiver loses the datagram, as on a network.
    (void)out_->SendTo(sensor.spec.to, EncodeSensorDatagram(dynamics_->Now(), states));
    sensor.next_ns += sensor.spec.period.ns();
    ++samples_;
    sent = true;
  }
  host_ns_ += OwnCpuNs() - start;
  return sent;
}

void World::ReceiveCommands(std::size_t index, std::int64_t now_ns) {
  const CommandChannelSpec& spec = scenario_.commands[index];
  for (;;) {
    auto received = command_sockets_[index].Receive();
    auto* datagram = std::get_if<std::optional<Datagram>>(&received);
    if (datagram == nullptr || !datagram->has_value()) return;
    auto wrench = DecodeCommandDatagram((*datagram)->payload);
    if (auto* error = std::get_if<DecodeError>(&wrench)) {
      fmt::print(stderr, "tcsim: channel {}: {}\n", spec.name, error->message);
      continue;
    }
    const std::int64_t at = std::max(now_ns, progress_ns()) + spec.latency.ns();
    dynamics_->Apply(spec.body, std::get<Wrench>(wrench), VirtualTime::FromNanoseconds(at));
    ++commands_;
  }
}

}  // namespace tcs
