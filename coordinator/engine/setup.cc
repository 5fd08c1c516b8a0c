// What a run needs before its first step: the run's memory, the sockets that clients find us by,
// the processor that they run on.
#include <errno.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <malloc.h>
#include <poll.h>
#include <signal.h>
#include <sys/epoll.h>
#include <sys/prctl.h>
#include <sys/signalfd.h>
#include <time.h>
#include <unistd.h>
#include <x86gprintrin.h>

#include <cmath>
#include <cstring>
#include <memory>
#include <new>
#include <utility>

#include "coordinator/calls/call_files.h"
#include "coordinator/calls/scheduling_rights.h"
#include "coordinator/core/engine.h"
#include "coordinator/core/locks.h"
#include "coordinator/host/fixed_meter.h"
#include "coordinator/host/measured_meter.h"
#include "coordinator/host/shared_cpu_meter.h"
#include "coordinator/os/cpu_claim.h"
#include "coordinator/os/end_signals.h"
#include "coordinator/os/guardian.h"
#include "coordinator/os/host.h"
#include "coordinator/os/shared_memory.h"
#include "coordinator/os/tsc_facts.h"
#include "coordinator/processes/client_folders.h"
#include "coordinator/scenario/patience.h"
#include "coordinator/tasks/signal_sets.h"
#include "shm/check.h"

namespace tcs {

namespace {

// Deterministic runs begin on 2024-01-01T00:00:00Z.
constexpr std::int64_t kFixedDateNs = 1'704'067'200'000'000'000;

// What is freed is kept for what is needed next. The page faults of memory that comes anew from the
// kernel take milliseconds where models meet, and their engine is built, in the middle of a run.
void KeepFreedMemory() {
  mallopt(M_MMAP_THRESHOLD, 32 << 20);
  mallopt(M_TRIM_THRESHOLD, 256 << 20);
}

}  // namespace

std::string Engine::Prepare() {
  KeepFreedMemory();
  state_link_.Open(run_.options.output_directory);
  state_link_.Does(Doing::kPrepares, __rdtsc());
  // What refuses the run comes first: before others are waited for, and before an earlier run's
  // results are written over.
  if (!run_.IsFixed() && KindOfHostsTsc() == TscKind::kNoClock) {
    return "this processor's TSC changes its rate or stops, and by it programs would be charged; "
           "use a machine whose /proc/cpuinfo shows constant_tsc and nonstop_tsc, or `--accounting "
           "fixed`, which needs no TSC";
  }
  if (std::string error = network_.Open(run_.scenario); !error.empty()) return error;
  const auto make_at = [this](const std::string& address, const std::function<void()>& make) {
    network_.MakeAt(address, make);
  };
  const bool is_recorded = run_.options.record != RecordingKind::kNone;
  const bool has_results = !run_.options.output_directory.empty();
  if (std::string error = world_.Open(run_.scenario, dds_.ends(), make_at,
                                      has_results ? &datagrams_ : nullptr, is_recorded);
      !error.empty()) {
    return error;
  }
  // A step that takes long is not to hold up who asks for the end.
  world_.InterruptBy([this] { return !run_.stop.asked() && HasSignal(); });
  if (std::string taken = TakeCpu(); !taken.empty()) return taken;
  // Before there are threads, which have the mask of whoever makes them, and files that tell that
  // the run has begun.
  if (std::string error = PrepareSignals(); !error.empty()) return error;
  const int home = HomeCpu();
  state_link_.RunsOn(home);
  const std::vector<int> further = ComputingAhead::CpusBeside(home, run_);
  helpers_cpus_ = World::ProcessorsBeside(home, run_.options.host_cpus);
  if (!GivesRealTime(real_time_)) IgnoreLackOfRealTimeLimit();
  if (!BindTo(0, home)) return "cannot bind to CPU " + std::to_string(home);
  if (run_.gates_only) {
    LeaveRealTime(0);  // which whoever started tcsim may have given it
    BeWokenInTime();
    UseNoLevels();
    TellOfMissingRights();
  } else {
    if (!SetLevel(0, Level::kCoordinator)) return "the coordinator's priority cannot be set";
  }
  if (std::string error = records_.Open(); !error.empty()) return error;
  if (has_results) {
    if (std::string error = OpenAnswers(); !error.empty()) return error;
  }
  if (std::string error = PrepareFolders(run_.scenario, run_.options); !error.empty()) return error;
  clock_.Calibrate();
  world_.UseProcessors(helpers_cpus_);
  prctl(PR_SET_CHILD_SUBREAPER, 1);
  RegisterHandlers();
  if (state_link_.wake_fd() >= 0) {
    reactor_.Add(state_link_.wake_fd(), EPOLLIN, {Tag::kStateAsked});
  }
  if (std::string error = PrepareMemory(); !error.empty()) return error;
  beside_.Open(home, further);
  ahead_.Open(home, further, beside_.cpu());
  if (std::string error = dds_.Open(); !error.empty()) return error;
  if (network_.present()) dds_.UseNetwork(*network_.wire());
  if (world_.present()) run_.root.UpdateDynamics(world_.progress(), world_.NextOutput());
  if (world_.has_terminals()) waker_.AwaitTerminals();
  std::uint32_t inlet = 0;
  for (const int fd : world_.command_fds()) {
    if (fd >= 0) reactor_.Add(fd, EPOLLIN, {Tag::kCommand, inlet});
    ++inlet;
  }
  std::uint32_t robot = 0;
  for (const int fd : network_.fds()) reactor_.Add(fd, EPOLLIN, {Tag::kNetwork, robot++});
  return PrepareHostCpu();
}

// Why there is none; empty if there is one.
std::string Engine::TakeCpu() {
  if (run_.gates_only) {
    share_.emplace();
    return {};
  }
  auto claim = ClaimCpu(run_.options.waits_for_cpu);
  if (const auto* taken = std::get_if<std::string>(&claim)) return *taken;
  claim_ = std::move(std::get<CpuClaim>(claim));
  ClientsRunOn(claim_.cpu);
  return {};
}

int Engine::HomeCpu() const { return share_.has_value() ? share_->cpu() : claim_.cpu; }

// Who is late, and why, is kept of runs whose results are.
std::string Engine::OpenAnswers() {
  answers_.Open(run_.scenario);
  activations_.Tell(&answers_, [this](const Task& task) {
    return PauseOf(task, run_, words_.table(), answers_);
  });
  dds_.records().UseAnswers(answers_);
  datagrams_.Tell(dds_.records().samples());
  if (run_.options.record != RecordingKind::kNone)
    datagram_log_.Open(run_.options.output_directory);
  return records_.Follow(answers_);
}

void Engine::TellOfMissingRights() const {
  if (!run_.options.on_notice) return;
  const bool may_have_levels = real_time_.error == 0;
  if (!may_have_levels) {
    run_.options.on_notice(
        "SCHED_FIFO is not permitted here, so gates keep the threads apart and the run takes "
        "longer: " +
        WhyNoRealTime(real_time_) + "; to have it, " + MendOfRealTime(real_time_));
  }
  if (run_.has_porters) {
    run_.options.on_notice(
        std::string("pidfd_getfd is refused here, so a process beside each program hands over its "
                    "descriptors and the run takes longer") +
        (may_have_levels ? ", without SCHED_FIFO, which is permitted" : "") +
        " (`tcsim doctor` says more)");
  }
  if (run_.IsFixed() && WhyNoFixedLayout() != 0) {
    run_.options.on_notice(
        "addresses differ from run to run here because personality is refused: programs that "
        "depend on them do not repeat to the byte (`tcsim doctor` says more)");
  }
}

std::string Engine::PrepareMemory() {
  SharedMemory memory = MakePublishedMemory("tcs-run", sizeof(shm::PublishedRun));
  if (!memory.fd) return fmt::format("the shared memory cannot be made: {}", strerror(errno));
  memfd_ = std::move(memory.fd);
  registration_.ShareMemory(memfd_.get());
  auto* published = new (memory.at) shm::PublishedRun{};
  world_.NameReceivers(published->own_receivers);
  const std::vector<std::size_t> commands = world_.CommandsOfReceivers();
  for (std::size_t i = 0; i < commands.size(); ++i)
    datagrams_.AddCommandAddress(published->own_receivers.addresses[i], commands[i]);
  local_sockets_.PublishIn(published->local_sockets);
  outside_.PublishIn(published->outside_files);
  memory_ = &published->run;
  run_.header = &memory_->header;
  run_.header->magic = shm::kMagic;
  run_.header->version = shm::kVersion;
  run_.header->header_size = sizeof(shm::RunHeader);
  run_.header->slot_size = sizeof(shm::ThreadSlot);
  run_.header->slot_count = shm::kSlotCount;
  run_.header->accounting = run_.options.accounting;
  run_.header->sync = run_.options.sync;
  run_.header->monotonic_offset_ns = run_.options.uptime_ns;
  run_.header->realtime_offset_ns =
      run_.options.date_ns.value_or(run_.IsFixed() ? kFixedDateNs : HostClockNs(CLOCK_REALTIME));
  run_.header->coordinator_pid = getpid();
  run_.header->counter_ticks_per_ns_q32 = CounterRate();
  run_.header->gates_only = run_.gates_only ? 1 : 0;
  run_.header->preempts = run_.SendsToGates() || SpinWaits::AsksThreads(run_) ? 1 : 0;
  run_.header->has_porters = run_.has_porters ? 1 : 0;
  run_.header->notes_activity = answers_.is_open() ? 1 : 0;
  run_.header->names_by_robot = run_.scenario.network.has_value() ? 1 : 0;
  return {};
}

bool Engine::HasSignal() const {
  pollfd asked{signal_fd_.get(), POLLIN, 0};
  return poll(&asked, 1, 0) > 0;
}

std::string Engine::PrepareSignals() {
  const sigset_t blocked = EndSignals();
  sigprocmask(SIG_BLOCK, &blocked, nullptr);
  signal(SIGPIPE, SIG_IGN);
  signal_fd_.Reset(signalfd(-1, &blocked, SFD_CLOEXEC | SFD_NONBLOCK));

  reactor_.Add(signal_fd_.get(), EPOLLIN, {Tag::kSignal});
  return {};
}

// Under set costs 1 GHz, the same on each host. Else the host's to the megahertz, for programs that
// ask the processor or /proc/cpuinfo for it.
std::uint64_t Engine::CounterRate() const {
  const double mhz = run_.IsFixed() ? 1000 : std::round(clock_.rate().ticks_per_ns * 1000);
  return static_cast<std::uint64_t>(mhz * 4294967296 / 1000);
}

// Of the next robot.
std::optional<std::uint64_t> Engine::TurnsSeed() const {
  if (!run_.IsFixed()) return std::nullopt;
  return run_.scenario.seed * 0x9e3779b97f4a7c15 + run_.robots.size();
}

void Engine::MakeRobots() {
  for (const RobotSpec& spec : run_.scenario.robots) {
    const auto cores = static_cast<std::uint32_t>(spec.cores);
    Robot& robot = run_.robots.emplace_back(
        spec.name, spec.speed,
        RobotScheduler(
            cores, !run_.IsCallback(),
            [this](int order) { return waker_.WaitOf(run_.table.At(order)); }, TurnsSeed()));
    robot.number = static_cast<std::uint32_t>(run_.robots.size());
    robot.is_ideal = spec.is_ideal;
    robot.is_ours = spec.is_ours;
    robot.outside_speed = spec.outside_speed;
    for (std::uint32_t core = 0; core < cores; ++core) {
      VirtualCpu& cpu = run_.cpus.emplace_back();
      cpu.robot = &robot;
      cpu.core = core;
      cpu.leaf = run_.root.AddLeaf(static_cast<int>(robot.number));
      robot.cpus.push_back(&cpu);
    }
  }
  if (network_.present()) {
    network_leaf_ = run_.root.AddLeaf(static_cast<int>(run_.robots.size()) + 1);
  }
  outside_leaf_ = run_.root.AddLeaf(static_cast<int>(run_.robots.size()) + 2);
}

std::string Engine::PrepareHostCpu() {
  std::unique_ptr<Meter> meter;
  if (run_.IsFixed()) {
    meter = std::make_unique<FixedMeter>(PatienceOf(run_.scenario).silent);
  } else if (run_.gates_only) {
    meter = std::make_unique<SharedCpuMeter>(clock_.rate());
  } else {
    meter = std::make_unique<MeasuredMeter>(clock_.rate());
  }
  if (std::string error = host_cpu_.Open(std::move(meter)); !error.empty()) return error;
  // As with any other process of ours.
  if (const int error = WhyNoLooksInto(host_cpu_.detector().pid()); error != 0) {
    return fmt::format(
        "tcsim may not read the memory of its own processes here ({}), so it cannot see what "
        "programs wait for; `tcsim doctor` says how to allow it",
        strerror(error));
  }
  reactor_.Add(host_cpu_.detector().fired_fd(), EPOLLIN, {Tag::kDetector});
  reactor_.Add(host_cpu_.detector().end_fd(), EPOLLIN, {Tag::kDetectorEnd});
  std::vector<pid_t> own = GuardsOf(getpid());
  own.insert(own.end(), {getpid(), host_cpu_.detector().pid()});
  guard_.Guard(std::move(own), [this](pid_t pid) { return run_.table.IsPorter(pid); });
  return {};
}

// Whoever keeps something for a thread that waits.
void Engine::TellOfWaits() {
  waker_.Tell({
      .began_by_signal =
          [this](Task& task) {
            signal_wakes_.EndAwait(task, SignalsOf(run_, task), {task.reached});
          },
      .left =
          [this](Task& task, Wait& left) {
            if (const auto* descriptors = left.As<awaited::Descriptors>())
              descriptors_.Leave(*descriptors);
            CallFiles::Keep(task, left);
            words_.table().Leave(task.order);
            objects_.Leave(task);
            inheritance_.Leave(task);
          },
      .ends_in_trapped_call =
          [this](Task& task, shm::WakeReason reason) { trapped_waits_.Finish(task, reason); },
      .deliverer_is_held_up =
          [this](const Process& process, Moment moment) {
            dds_.ReleaseThoseAwaitingDeliverer(process, moment);
          },
      .does_nothing_before = [this](const VirtualCpu& cpu) { return ahead_.EndOfDebt(cpu); },
  });
}

void Engine::TellOfEnds() {
  deaths_.Tell({
      .settle = [this](Task& task) { Settle(task); },
      .thread_ends = [this](Task& task, Moment moment) { shared_events_.PassOn(task, moment); },
      .thread_has_ended =
          [this](Task& task) {
            beside_.Forget(task);
            objects_.Forget(task);
            ahead_.Forget(task);
            registration_.Forget(task);
            task.kept.reset();
          },
      .wake_those_waiting_for = [this](Task& task,
                                       Moment moment) { locks_.WakeThoseWaitingFor(task, moment); },
      .child_has_ended = [this](
                             Process& parent, pid_t child,
                             Moment moment) { stops_.ChildChanged(parent, child, false, moment); },
      .process_has_ended =
          [this](Process& process, Moment moment) {
            if (process.is_client) launches_.ClientHasEnded(process);
            if (process.is_client && process.robot->is_ours && !run_.IsInGrace()) {
              run_.Warn(fmt::format(
                  "tcs-dds-gateway has ended at {:.3f} s, so from then on programs whose DDS uses "
                  "sockets have no sensors, clock and commands of the type dds; what it has said "
                  "on stderr says why",
                  moment.at.seconds()));
            }
            objects_.WakeAll(moment);
            dds_.Leave(process, moment);
          },
  });
}

}  // namespace tcs
