#include "coordinator/core/world.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <time.h>

#include <algorithm>
#include <cerrno>
#include <numeric>

#include "coordinator/channel/json_codec.h"
#include "coordinator/os/file_errors.h"
#include "coordinator/os/host.h"
#include "shm/layout.h"

namespace tcs {

namespace {

constexpr std::size_t kCsvAtOnce = 64 << 10;

// Adds to `total_ns` what the coordinator spends in a scope.
class Spent {
 public:
  explicit Spent(std::int64_t* total_ns)
      : total_ns_(total_ns), start_ns_(HostClockNs(CLOCK_THREAD_CPUTIME_ID)) {}
  ~Spent() { *total_ns_ += HostClockNs(CLOCK_THREAD_CPUTIME_ID) - start_ns_; }
  Spent(const Spent&) = delete;
  Spent& operator=(const Spent&) = delete;

 private:
  std::int64_t* total_ns_;
  std::int64_t start_ns_;
};

}  // namespace

std::string World::Open(const Scenario& scenario) {
  scenario_ = scenario;
  if (!scenario.world.has_value()) return {};
  dynamics_ = MakeDynamics(*scenario.world);
  all_bodies_.resize(scenario.world->bodies.size());
  std::iota(all_bodies_.begin(), all_bodies_.end(), 0);
  for (const SensorChannelSpec& spec : scenario.sensors) {
    sensors_.push_back({spec, 0, {}});
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
  FindNextStop();
  return {};
}

std::string World::OpenCsv(const std::string& path) {
  if (!present()) return {};
  csv_path_ = path;
  errno = 0;
  csv_.rdbuf()->pubsetbuf(nullptr, 0);
  csv_.open(path);
  if (!csv_) return CannotBeWritten(path);
  csv_ << "time_s,body,x_m,y_m,z_m,qx,qy,qz,qw,vx_mps,vy_mps,vz_mps,wx_radps,wy_radps,wz_radps\n";
  FindNextStop();
  return {};
}

// Whole lines: what a run leaves that is killed has no halves.
void World::FlushCsv() {
  csv_ << csv_text_;
  csv_text_.clear();
}

std::string World::CloseCsv() {
  if (!csv_.is_open()) return {};
  errno = 0;
  FlushCsv();
  csv_.close();
  return csv_ ? "" : NotWrittenWhole(csv_path_);
}

void World::OpenDds(dds::OwnEndpoints& ends, std::int64_t realtime_offset_ns) {
  if (!present()) return;
  if (scenario_.dds_sensors.empty() && scenario_.dds_commands.empty() &&
      !scenario_.clock.has_value()) {
    return;
  }
  dds_.emplace(scenario_, ends, realtime_offset_ns, input_);
  FindNextStop();
}

void World::FindNextStop() {
  next_output_ns_ = shm::kNeverNs;
  next_stop_ns_ = csv_.is_open() ? next_csv_ns_ : shm::kNeverNs;
  for (const Sensor& sensor : sensors_) {
    const std::int64_t arrival = sensor.on_the_way.empty()
                                     ? sensor.next_ns + sensor.spec.latency.ns()
                                     : sensor.on_the_way.front().first;
    next_output_ns_ = std::min(next_output_ns_, arrival);
    next_stop_ns_ = std::min({next_stop_ns_, arrival, sensor.next_ns});
  }
  if (dds_.has_value()) {
    next_output_ns_ = std::min(next_output_ns_, dds_->NextOutputNs());
    next_stop_ns_ = std::min(next_stop_ns_, dds_->NextSampleNs());
  }
}

void World::WriteCsv() {
  const std::int64_t now = progress_ns_;
  if (!csv_.is_open() || now < next_csv_ns_) return;
  next_csv_ns_ += scenario_.csv_period.ns();
  states_.resize(all_bodies_.size());
  dynamics_->Read(dynamics_->Now(), all_bodies_, states_);
  for (std::size_t i = 0; i < states_.size(); ++i) {
    const BodyState& s = states_[i];
    csv_text_ += fmt::format(
        "{:.9f},{},{},{},{},{}\n", static_cast<double>(now) * 1e-9, scenario_.world->bodies[i].name,
        fmt::join(s.position_m, ","), fmt::join(s.orientation_xyzw, ","),
        fmt::join(s.linear_velocity_mps, ","), fmt::join(s.angular_velocity_radps, ","));
  }
  if (csv_text_.size() > kCsvAtOnce) FlushCsv();
}

void World::Sample(Sensor& sensor) {
  const std::vector<int>& bodies = sensor.spec.bodies;
  states_.resize(bodies.size());
  dynamics_->Read(dynamics_->Now(), bodies, states_);
  std::vector<NamedBodyState> states;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const auto body = static_cast<std::size_t>(bodies[i]);
    states.push_back({scenario_.world->bodies[body].name, states_[i]});
  }
  sensor.on_the_way.emplace_back(progress_ns_ + sensor.spec.latency.ns(),
                                 EncodeSensorDatagram(dynamics_->Now(), states));
  sensor.next_ns += sensor.spec.period.ns();
  ++samples_;
}

bool World::SendDue(Sensor& sensor) {
  bool sent = false;
  while (!sensor.on_the_way.empty() && sensor.on_the_way.front().first <= progress_ns_) {
    // A full or absent receiver loses the datagram, as on a network.
    (void)out_->SendTo(sensor.spec.to, sensor.on_the_way.front().second);
    sensor.on_the_way.pop_front();
    sent = true;
  }
  return sent;
}

// All that is read now at once: what many bodies need is integrated side by side.
void World::IntegrateDue() {
  due_.clear();
  if (csv_.is_open() && next_csv_ns_ <= progress_ns_) due_ = all_bodies_;
  for (const Sensor& sensor : sensors_) {
    if (sensor.next_ns > progress_ns_) continue;
    due_.insert(due_.end(), sensor.spec.bodies.begin(), sensor.spec.bodies.end());
  }
  if (dds_.has_value()) dds_->AddDueBodies(progress_ns_, &due_);
  states_.resize(due_.size());
  dynamics_->Read(dynamics_->Now(), due_, states_);
}

bool World::Advance(std::int64_t limit_ns) {
  const Spent spent(&host_ns_);
  progress_ns_ = std::max(progress_ns_, std::min(limit_ns, next_stop_ns_));
  Settle(progress_ns_);
  IntegrateDue();
  WriteCsv();
  bool sent = false;
  for (Sensor& sensor : sensors_) {
    if (sensor.next_ns <= progress_ns_) Sample(sensor);
    sent |= SendDue(sensor);
  }
  if (dds_.has_value() && dds_->NextSampleNs() <= progress_ns_) {
    samples_ += dds_->WriteDue(progress_ns_, [this](int body) { return dynamics_->Read(body); });
    sent = true;
  }
  FindNextStop();
  return sent;
}

// The dynamics integrate what somebody reads, and nobody does before the next stop.
void World::Lead(std::int64_t settled_ns, std::int64_t to_ns) {
  Settle(settled_ns);
  progress_ns_ = to_ns;
}

void World::Settle(std::int64_t settled_ns) {
  settled_ns_ = settled_ns;
  dynamics_->AdvanceTo(VirtualTime::FromNanoseconds(settled_ns));
}

void World::Apply(std::int64_t at_ns, int body, const Wrench& wrench) {
  dynamics_->Apply(body, wrench, VirtualTime::FromNanoseconds(at_ns));
}

void World::ReceiveCommands(std::size_t index, std::int64_t now_ns) {
  const Spent spent(&host_ns_);
  const CommandChannelSpec& spec = scenario_.commands[index];
  for (;;) {
    auto received = command_sockets_[index].Receive();
    auto* datagram = std::get_if<std::optional<Datagram>>(&received);
    if (datagram == nullptr || !datagram->has_value()) return;
    auto wrench = DecodeCommandDatagram((*datagram)->payload);
    if (auto* error = std::get_if<DecodeError>(&wrench)) {
      input_.Refused(spec.name, error->message);
      continue;
    }
    input_.Took(spec.name);
    Apply(std::max(now_ns, settled_ns_) + spec.latency.ns(), spec.body, std::get<Wrench>(wrench));
    ++commands_;
  }
}

void World::TakeDdsCommands(std::int64_t now_ns) {
  const Spent spent(&host_ns_);
  while (const auto commands = dds_->TakeCommands(now_ns)) {
    for (const DdsChannels::Command& command : *commands) {
      Apply(std::max(command.at_ns, settled_ns_), command.body, command.wrench);
      ++commands_;
    }
  }
}

}  // namespace tcs
