#include "coordinator/world/world.h"

#include <sys/socket.h>
#include <time.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <iterator>
#include <numeric>
#include <system_error>
#include <utility>

#include "coordinator/os/cpu_claim.h"
#include "coordinator/os/cpu_places.h"
#include "coordinator/os/file_errors.h"
#include "coordinator/port/clocks.h"
#include "coordinator/world/csv_row.h"
#include "coordinator/world/scene_text.h"
#include "shm/check.h"
#include "shm/layout.h"

namespace tcs {

namespace {

constexpr std::size_t kCsvAtOnce = 64 << 10;

// Adds to `total_ns` what the coordinator spends in a scope. The CPU clock takes a system call,
// which is a third of what one command takes; so for short scopes there is the wall clock, which
// differs only where the host gives the processor to others meanwhile.
class Spent {
 public:
  explicit Spent(std::int64_t* total_ns, clockid_t clock = CLOCK_THREAD_CPUTIME_ID)
      : total_ns_(total_ns), clock_(clock), start_ns_(HostClockNs(clock)) {}
  ~Spent() { *total_ns_ += HostClockNs(clock_) - start_ns_; }
  Spent(const Spent&) = delete;
  Spent& operator=(const Spent&) = delete;

 private:
  std::int64_t* total_ns_;
  clockid_t clock_;
  std::int64_t start_ns_;
};

// The network namespace of a socket, as SO_NETNS_COOKIE has it; 0 where the kernel does not tell
// (before Linux 5.14).
std::uint64_t NetworkOf(int fd) {
  std::uint64_t cookie = 0;
  socklen_t size = sizeof cookie;
  return getsockopt(fd, SOL_SOCKET, SO_NETNS_COOKIE, &cookie, &size) == 0 ? cookie : 0;
}

}  // namespace

World::World(std::function<void(const std::string&)> warn)
    : commands_(
          std::move(warn),
          [this](VirtualTime sent, VirtualDuration latency, int body, const Wrench& wrench) {
            dynamics_->Apply(body, wrench, ActsAt(sent, latency));
          },
          [this](VirtualTime sent, VirtualDuration latency, int joint, const JointDrive& drive) {
            dynamics_->Drive(joint, drive, ActsAt(sent, latency));
          },
          [this](VirtualTime sent, VirtualDuration latency, int rotor, double speed_radps) {
            dynamics_->Spin(rotor, speed_radps, ActsAt(sent, latency));
          },
          [this](VirtualTime sent, VirtualDuration latency, int link, WrenchFrame frame,
                 const Wrench& wrench) {
            dynamics_->ApplyToLink(link, frame, wrench, ActsAt(sent, latency));
          },
          [this](VirtualTime at, std::span<const int> joints, std::span<JointState> states) {
            dynamics_->ReadJoints(std::max(at, dynamics_->Now()), joints, states);
          }) {}

std::string World::Open(const Scenario& scenario, dds::OwnEndpoints& ends, const MakeAt& make_at,
                        DatagramWatch* watch, bool is_recorded) {
  scenario_ = scenario;
  if (!scenario.world.has_value()) return {};
  try {
    dynamics_ = MakeDynamics(*scenario.world);
  } catch (const DynamicsError& error) {
    return error.what();
  }
  all_bodies_.resize(scenario.world->bodies.size());
  std::iota(all_bodies_.begin(), all_bodies_.end(), 0);
  states_.resize(all_bodies_.size());
  link_lines_ = LinkLines(*scenario.world);
  joint_lines_ = JointLines(*scenario.world);
  contact_lines_ = ContactLines(*scenario.world);
  sensors_ = Sensors(scenario_.world->gravity_mps2);
  std::vector<std::string> names_of_bodies;
  for (const BodySpec& body : scenario.world->bodies) names_of_bodies.push_back(body.name);
  commands_.Open(scenario_.commands, std::move(names_of_bodies));
  if (std::string error = channels_.Open(scenario_, ends, make_at); !error.empty()) return error;
  if (watch != nullptr) channels_.TellOf(*watch, scenario_);
  metrics_.Open(scenario_);
  for (std::size_t i = 0; i < channels_.outlets.size(); ++i) {
    auto& outlet = channels_.outlets[i];
    outlet = metrics_.Wrap(i, std::move(outlet));
  }
  if (is_recorded) {
    channels_.Record(scenario_, channel_records_.emplace(scenario_));
    for (std::size_t i = 0; i < channels_.outlets.size(); ++i) {
      auto& outlet = channels_.outlets[i];
      outlet = measurements_.Wrap(scenario_.sensors[i], std::move(outlet));
    }
    is_recorded_ = true;
  }
  if (channels_.clock != nullptr) {
    sensors_.Add({}, {.period = scenario_.clock->period, .latency = {}}, {}, *channels_.clock);
  }
  for (std::size_t i = 0; i < scenario_.sensors.size(); ++i) {
    const SensorChannelSpec& spec = scenario_.sensors[i];
    const SensorTiming timing{.period = spec.period, .latency = spec.latency};
    if (spec.instrument) {
      sensors_.AddInstrument(MakeInstrument(*spec.instrument, spec.period, *scenario_.world),
                             timing, spec.errors, spec.measurement_errors, *channels_.outlets[i]);
      continue;
    }
    if (spec.joints) {
      sensors_.AddJoints(*spec.joints, timing, spec.errors, *channels_.outlets[i]);
      continue;
    }
    std::vector<Sensors::Body> bodies;
    for (const int body : spec.bodies) {
      bodies.push_back({body, scenario_.world->bodies[static_cast<std::size_t>(body)].name});
    }
    sensors_.Add(std::move(bodies), timing, spec.errors, *channels_.outlets[i]);
  }
  for (const auto& inlet : channels_.inlets) {
    if (inlet->IsTerminal()) terminals_.push_back(inlet.get());
  }
  FindNextStop();
  return {};
}

std::string WhyNoWorld(const Scenario& scenario) {
  try {
    if (scenario.world.has_value()) MakeDynamics(*scenario.world);
  } catch (const DynamicsError& error) {
    return error.what();
  }
  return {};
}

std::vector<int> World::ProcessorsBeside(int home, int host_cpus) {
  std::vector<int> cpus = CpusBesideHome(home, host_cpus);
  std::erase_if(cpus, IsClaimed);
  return cpus;
}

void World::UseProcessors(const std::vector<int>& cpus) {
  if (present()) dynamics_->UseProcessors(cpus);
}

void World::Begin(std::int64_t realtime_offset_ns) {
  channels_.Begin(VirtualDuration::Nanoseconds(realtime_offset_ns));
}

std::string World::OpenRecords(const std::string& folder) {
  // Files of an earlier run would be taken for this run's.
  std::error_code ignored;
  for (const char* file : {"/scene.json", "/bodies.csv", "/joints.csv", "/contacts.csv",
                           "/commands.csv", "/sensors.csv"}) {
    std::filesystem::remove(folder + file, ignored);
  }
  if (!present()) return {};
  errno = 0;
  if (!(std::ofstream(folder + "/scene.json") << SceneText(scenario_) << std::flush)) {
    return CannotBeWritten(folder + "/scene.json");
  }
  csv_path_ = folder + "/bodies.csv";
  errno = 0;
  csv_.rdbuf()->pubsetbuf(nullptr, 0);
  csv_.open(csv_path_);
  if (!csv_) return CannotBeWritten(csv_path_);
  csv_ << kBodiesCsvHead;
  FindNextStop();
  std::string error;
  if (!joint_lines_.empty()) error = joints_csv_.Open(folder + "/joints.csv", kJointsCsvHead);
  if (error.empty() && scenario_.csv_contacts) {
    error = contacts_csv_.Open(folder + "/contacts.csv", kContactsCsvHead);
  }
  if (error.empty() && !scenario_.commands.empty()) {
    error = commands_.log().Open(folder + "/commands.csv");
  }
  if (error.empty() && is_recorded_ && !scenario_.sensors.empty()) {
    error = measurements_.Open(folder + "/sensors.csv");
  }
  return error;
}

// Writes whole lines: the file of a run that is killed has no half lines.
void World::FlushBodies() {
  csv_ << csv_text_;
  csv_text_.clear();
}

void World::FlushRecords() {
  FlushBodies();
  joints_csv_.Flush();
  contacts_csv_.Flush();
  commands_.log().Flush();
  measurements_.Flush();
}

std::string World::CloseRecords() {
  if (!csv_.is_open()) return {};
  errno = 0;
  FlushBodies();
  csv_.close();
  if (!csv_) return NotWrittenWhole(csv_path_);
  for (const std::string& error : {joints_csv_.Close(), contacts_csv_.Close(),
                                   commands_.log().Close(), measurements_.Close()}) {
    if (!error.empty()) return error;
  }
  return {};
}

void World::Measure(MetricBook& book) {
  if (!present()) return;
  metrics_.WriteInto(book, commands_.log());
  FindNextStop();
}

void World::RecordInto(record::MessageSink& sink) {
  if (!present()) return;
  topics_.emplace(scenario_, sink);
  channel_records_->RecordInto(sink);
}

void World::FindNextStop() {
  next_output_ = sensors_.NextArrival();
  next_stop_ = std::min({csv_.is_open() ? next_csv_ : VirtualTime::Never(), sensors_.NextStop(),
                         commands_.NextStop(), metrics_.NextStop()});
}

void World::WriteStates() {
  const VirtualTime now = progress_;
  if (!csv_.is_open() || now < next_csv_) return;
  next_csv_ += scenario_.csv_period;
  for (std::size_t i = 0; i < states_.size(); ++i) {
    const BodyState& s = states_[i];
    AppendBodiesCsvRow(now, scenario_.world->bodies[i].name, s.position_m, s.orientation_xyzw,
                       s.linear_velocity_mps, s.angular_velocity_radps, &csv_text_);
  }
  link_lines_.Append(*dynamics_, &csv_text_);
  if (topics_) topics_->Write(now, states_, link_lines_.states());
  joint_lines_.Write(*dynamics_, &joints_csv_);
  if (contacts_csv_.is_open()) contact_lines_.Write(*dynamics_, &contacts_csv_);
  if (csv_text_.size() > kCsvAtOnce) FlushBodies();
}

// Reads all bodies that are due now at once: the steps that many bodies need are integrated side by
// side.
void World::ReadDue() {
  if (csv_.is_open() && next_csv_ <= progress_) {
    due_ = all_bodies_;
  } else {
    due_.clear();
    sensors_.AddDueBodies(progress_, &due_);
    std::ranges::sort(due_);
    due_.erase(std::unique(due_.begin(), due_.end()), due_.end());
  }
  read_.resize(due_.size());
  dynamics_->Read(dynamics_->Now(), due_, read_);
  for (std::size_t i = 0; i < due_.size(); ++i) {
    states_[static_cast<std::size_t>(due_[i])] = read_[i];
  }
}

bool World::Advance(VirtualTime limit) {
  const Spent spent(&host_ns_);
  progress_ = std::max(progress_, std::min(limit, next_stop_));
  const VirtualTime sent_until = std::min(progress_, limit);
  PassOnSentUntil(sent_until);
  commands_.ActUntil(sent_until);
  // A command that came while the dynamics led may have made firmware act before their progress.
  if (limit < progress_) {
    FindNextStop();
    return false;
  }
  Settle(progress_);
  ReadDue();
  due_links_.Read(sensors_, progress_, *dynamics_);
  WriteStates();
  const bool sent = sensors_.Act(
      progress_, [this](int body) { return states_[static_cast<std::size_t>(body)]; },
      {.links = [this](std::span<const int> links,
                       std::span<LinkState> states) { due_links_.Give(links, states); },
       .joints =
           [this](std::span<const int> joints, std::span<JointState> states) {
             dynamics_->ReadJoints(dynamics_->Now(), joints, states);
           }});
  metrics_.Evaluate(*dynamics_);
  if (sent) ReceiveFromTerminals(progress_);  // the terminals' echo
  FindNextStop();
  return sent;
}

void World::LetLastCommandsAct(VirtualTime end) {
  if (!present()) return;
  PassOnSentUntil(end);
  commands_.ActUntil(end);
}

// The dynamics integrate what is read, and nothing reads them before the next stop. Other threads
// may still be woken earlier than `now`, but no further back than the drift bound.
void World::Lead(VirtualTime now, VirtualTime to) {
  if (PassOnSentUntil(now - scenario_.drift_bound)) FindNextStop();
  Settle(std::min(now - scenario_.drift_bound, commands_.NextStop()));
  progress_ = std::max(progress_, to);
}

// Passes on the commands that were sent by `time`. Firmware acts until each command's time first.
// True if there was a command.
bool World::PassOnSentUntil(VirtualTime time) {
  return queue_.PassOn(time, [this](VirtualTime at) { commands_.ActUntil(at); });
}

void World::Settle(VirtualTime time) {
  if (time > dynamics_->Now()) dynamics_->AdvanceTo(time);
}

VirtualTime World::ActsAt(VirtualTime sent, VirtualDuration latency) const {
  return std::max(sent, dynamics_->Now()) + latency;
}

std::vector<int> World::command_fds() const {
  std::vector<int> fds;
  for (const auto& inlet : channels_.inlets) fds.push_back(inlet->fd());
  return fds;
}

void World::ReceiveCommands(std::size_t index, VirtualTime now, const CommandSender& from) {
  const Spent spent(&host_ns_, CLOCK_MONOTONIC);
  channels_.inlets[index]->Receive({now, from}, queue_);
  NoteSent(now);
}

void World::ReceivePosted(std::size_t receiver, std::string_view datagram,
                          const CommandSent& sent) {
  const Spent spent(&host_ns_, CLOCK_MONOTONIC);
  channels_.inlets[inlet_of_receiver_[receiver]]->Accept(datagram, sent, queue_);
  NoteSent(sent.at);
}

// Where the dynamics lead, the command is taken all the same once no thread can send for an earlier
// time.
void World::NoteSent(VirtualTime at) {
  if (at < progress_) next_stop_ = std::min(next_stop_, at);
}

void World::NameReceivers(shm::OwnReceivers& receivers) {
  struct Receiver {
    shm::ReceiverAddress address;
    std::size_t inlet;
  };
  std::vector<Receiver> found;
  const std::vector<int> fds = command_fds();
  for (std::size_t inlet = 0; inlet < fds.size(); ++inlet) {
    const int fd = fds[inlet];
    sockaddr_storage address;
    socklen_t size = sizeof address;
    int type = 0;
    socklen_t type_size = sizeof type;
    if (fd < 0 || getsockopt(fd, SOL_SOCKET, SO_TYPE, &type, &type_size) != 0 ||
        type != SOCK_DGRAM || getsockname(fd, reinterpret_cast<sockaddr*>(&address), &size) != 0) {
      continue;
    }
    if (found.size() == shm::OwnReceivers::kMost) break;
    found.push_back({shm::AddressOf(&address, size), inlet});
  }
  std::ranges::sort(found, shm::IsBefore, &Receiver::address);
  for (const Receiver& receiver : found) {
    receivers.addresses[receivers.count++] = receiver.address;
    inlet_of_receiver_.push_back(receiver.inlet);
  }
  // Where robots have networks of their own, their datagrams take their way there.
  if (!found.empty() && !scenario_.network) receivers.network = NetworkOf(fds[found[0].inlet]);
}

std::vector<std::size_t> World::CommandsOfReceivers() const {
  std::vector<std::size_t> commands;
  for (const std::size_t inlet : inlet_of_receiver_) {
    // In a recording inlets are wrapped: a wrapped inlet has the descriptor of its inlet.
    const auto of =
        std::ranges::find(channels_.inlet_of, channels_.inlets[inlet]->fd(), &Inlet::fd);
    TCS_CHECK(of != channels_.inlet_of.end());
    commands.push_back(static_cast<std::size_t>(of - channels_.inlet_of.begin()));
  }
  return commands;
}

std::string World::WhomMoves(const CommandChannelSpec& spec) const {
  if (spec.link) return spec.link->name;
  if (spec.joints) return spec.joints->group.model;
  if (spec.rotors) return spec.rotors->model;
  return scenario_.world->bodies[static_cast<std::size_t>(spec.body)].name;
}

std::vector<std::string> World::CommandComplaints() const {
  std::vector<std::string> complaints;
  for (std::size_t i = 0; i < channels_.inlet_of.size(); ++i) {
    complaints.push_back(commands_.ComplaintAbout(i, channels_.inlet_of[i]->PlaceOf(i),
                                                  WhomMoves(scenario_.commands[i])));
  }
  std::erase(complaints, "");
  std::ranges::move(commands_.ComplaintsAboutActuators(), std::back_inserter(complaints));
  return complaints;
}

std::vector<std::pair<std::size_t, std::size_t>> World::KeptReadings() const {
  std::vector<std::pair<std::size_t, std::size_t>> kept;
  for (std::size_t i = 0; i < channels_.outlets.size(); ++i) {
    if (const std::size_t count = channels_.outlets[i]->Kept(); count > 0)
      kept.emplace_back(i, count);
  }
  return kept;
}

std::vector<std::string> World::UnheardSensors() const {
  return OfSensors([](const Outlet& outlet) { return outlet.WhyUnheard(); });
}

std::vector<std::string> World::LossesOfSensors() const {
  return OfSensors([](const Outlet& outlet) { return outlet.WhatWasLost(); });
}

std::vector<std::string> World::OfSensors(
    const std::function<std::string(const Outlet&)>& what) const {
  std::vector<std::string> sentences;
  for (std::size_t i = 0; i < channels_.outlets.size(); ++i) {
    const std::string text = what(*channels_.outlets[i]);
    if (!text.empty()) sentences.push_back("channel " + scenario_.sensors[i].name + ": " + text);
  }
  return sentences;
}

std::string World::AliasesOf(const std::string& robot) const {
  std::string text;
  for (const FileAlias& alias : channels_.aliases) {
    if (alias.robot == robot) text += alias.file + " " + alias.name + "\n";
  }
  return text;
}

void World::ReceiveFromTerminals(VirtualTime now) {
  if (terminals_.empty()) return;
  const Spent spent(&host_ns_);
  PassOnSentUntil(now);
  for (Inlet* terminal : terminals_) {
    terminal->Receive(now, commands_);
  }
  FindNextStop();
}

void World::ReceiveUntold(VirtualTime now) {
  const Spent spent(&host_ns_);
  PassOnSentUntil(now);
  for (const auto& inlet : channels_.inlets) {
    if (inlet->fd() < 0) inlet->Receive(now, commands_);
  }
  FindNextStop();
}

}  // namespace tcs
