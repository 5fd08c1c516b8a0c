#include "coordinator/engine/setup.h"

#include <errno.h>
#include <fmt/format.h>
#include <malloc.h>
#include <sys/epoll.h>
#include <sys/prctl.h>
#include <time.h>
#include <unistd.h>

#include <cmath>
#include <cstring>
#include <functional>
#include <memory>
#include <new>
#include <utility>
#include <vector>

#include "coordinator/calls/call_files.h"
#include "coordinator/calls/scheduling_rights.h"
#include "coordinator/engine/locks.h"
#include "coordinator/engine/wiring.h"
#include "coordinator/host/fixed_meter.h"
#include "coordinator/host/measured_meter.h"
#include "coordinator/host/shared_cpu_meter.h"
#include "coordinator/os/guardian.h"
#include "coordinator/os/shared_memory.h"
#include "coordinator/os/spawning.h"
#include "coordinator/os/tsc_facts.h"
#include "coordinator/port/call_times.h"
#include "coordinator/port/clocks.h"
#include "coordinator/port/levels.h"
#include "coordinator/port/traps.h"
#include "coordinator/processes/client_folders.h"
#include "coordinator/scenario/patience.h"
#include "coordinator/tasks/signal_sets.h"

namespace tcs {

namespace {

// Deterministic runs begin on 2024-01-01T00:00:00Z.
constexpr std::int64_t kFixedDateNs = 1'704'067'200'000'000'000;

// Freed memory is kept for what is needed next. The page faults of memory that comes anew from the
// kernel take milliseconds where models meet, and their engine is built, in the middle of a run.
void KeepFreedMemory() {
  mallopt(M_MMAP_THRESHOLD, 32 << 20);
  mallopt(M_TRIM_THRESHOLD, 256 << 20);
}

}  // namespace

void Setup::Connect() {
  TellOfWaits();
  TellOfEnds();
}

std::string Setup::Prepare() {
  KeepFreedMemory();
  all_.state_link.Open(run_.options.output_directory);
  all_.state_link.Does(Doing::kPrepares, HostTsc());
  // Checks that may refuse the run come first: before other runs are waited for, and before an
  // earlier run's results are written over.
  if (!run_.IsFixed() && KindOfHostsTsc() == TscKind::kNoClock) {
    return "this processor's TSC changes its rate or stops, and by it programs would be charged; "
           "use a machine whose /proc/cpuinfo shows constant_tsc and nonstop_tsc, or `--accounting "
           "fixed`, which needs no TSC";
  }
  if (std::string error = all_.network.Open(run_.scenario); !error.empty()) return error;
  const auto make_at = [this](const std::string& address, const std::function<void()>& make) {
    all_.network.MakeAt(address, make);
  };
  const bool is_recorded = run_.options.record != RecordingKind::kNone;
  const bool has_results = !run_.options.output_directory.empty();
  if (std::string error = all_.world.Open(run_.scenario, all_.dds.ends(), make_at,
                                          has_results ? &all_.datagrams : nullptr, is_recorded);
      !error.empty()) {
    return error;
  }
  // A step that takes long is not to hold up a request to end the run.
  all_.world.InterruptBy([this] { return !run_.stop.asked() && all_.end_requests.IsPending(); });
  if (std::string taken = all_.home_processor.Take(run_); !taken.empty()) return taken;
  // Before there are threads, which inherit the signal mask of the thread that creates them, and
  // before there are files that tell that the run has begun.
  all_.end_requests.Open(all_.reactor);
  const int home = all_.home_processor.cpu();
  all_.state_link.RunsOn(home);
  const std::vector<int> further = ComputingAhead::CpusBeside(home, run_);
  all_.home_processor.UseHelpers(World::ProcessorsBeside(home, run_.options.host_cpus));
  if (!GivesRealTime(all_.real_time)) IgnoreLackOfRealTimeLimit();
  if (!BindTo(0, home)) return "cannot bind to CPU " + std::to_string(home);
  if (run_.is_unprivileged) {
    LeaveRealTime(0);  // which tcsim may have been started with
    BeWokenInTime();
    UseNoLevels();
    TellOfMissingRights();
  } else {
    if (!SetLevel(0, Level::kCoordinator)) return "the coordinator's priority cannot be set";
  }
  if (std::string error = all_.records.Open(); !error.empty()) return error;
  if (has_results) {
    if (std::string error = OpenAnswers(); !error.empty()) return error;
  }
  if (std::string error = PrepareFolders(run_.scenario, run_.options); !error.empty()) return error;
  all_.world.UseProcessors(all_.home_processor.helpers());
  prctl(PR_SET_CHILD_SUBREAPER, 1);
  return PrepareParts(further);
}

std::string Setup::PrepareParts(const std::vector<int>& further_cpus) {
  const int home = all_.home_processor.cpu();
  all_.clock.Calibrate();
  all_.kernel_events.Register();
  if (all_.state_link.wake_fd() >= 0) {
    all_.reactor.Add(all_.state_link.wake_fd(), EPOLLIN, {Tag::kStateAsked});
  }
  if (std::string error = PrepareMemory(); !error.empty()) return error;
  all_.beside.Open(home, further_cpus);
  all_.ahead.Open(home, further_cpus, all_.beside.cpu());
  if (std::string error = all_.dds.Open(); !error.empty()) return error;
  if (all_.network.present()) all_.dds.UseNetwork(*all_.network.wire());
  if (all_.world.present())
    run_.root.UpdateDynamics(all_.world.progress(), all_.world.NextOutput());
  if (all_.world.has_terminals()) all_.waker.AwaitTerminals();
  std::uint32_t inlet = 0;
  for (const int fd : all_.world.command_fds()) {
    if (fd >= 0) all_.reactor.Add(fd, EPOLLIN, {Tag::kCommand, inlet});
    ++inlet;
  }
  std::uint32_t robot = 0;
  for (const int fd : all_.network.fds()) all_.reactor.Add(fd, EPOLLIN, {Tag::kNetwork, robot++});
  return PrepareHostCpu();
}

// The records of who is late, and why, are kept for runs whose results are kept.
std::string Setup::OpenAnswers() {
  all_.answers.Open(run_.scenario);
  all_.activations.Tell(&all_.answers, [this](const Task& task) {
    return PauseOf(task, run_, all_.words.table(), all_.answers);
  });
  all_.dds.records().UseAnswers(all_.answers);
  all_.datagrams.Tell(all_.dds.records().samples());
  if (run_.options.record != RecordingKind::kNone)
    all_.datagram_log.Open(run_.options.output_directory);
  return all_.records.Follow(all_.answers);
}

void Setup::TellOfMissingRights() const {
  if (!run_.options.on_notice) return;
  const bool may_have_levels = all_.real_time.error == 0;
  if (!may_have_levels) {
    run_.options.on_notice(
        "SCHED_FIFO is not permitted here, so gates keep the threads apart and the run takes "
        "longer: " +
        WhyNoRealTime(all_.real_time) + "; to have it, " + MendOfRealTime(all_.real_time));
  }
  if (run_.has_brokers) {
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

std::string Setup::PrepareMemory() {
  SharedMemory memory = MakePublishedMemory("tcs-run", sizeof(shm::PublishedRun));
  if (!memory.fd) return fmt::format("the shared memory cannot be made: {}", strerror(errno));
  all_.memfd = std::move(memory.fd);
  all_.registration.ShareMemory(all_.memfd.get());
  auto* published = new (memory.at) shm::PublishedRun{};
  all_.world.NameReceivers(published->own_receivers);
  const std::vector<std::size_t> commands = all_.world.CommandsOfReceivers();
  for (std::size_t i = 0; i < commands.size(); ++i)
    all_.datagrams.AddCommandAddress(published->own_receivers.addresses[i], commands[i]);
  all_.local_sockets.PublishIn(published->local_sockets);
  all_.outside.PublishIn(published->outside_files);
  all_.memory = &published->run;
  run_.header = &all_.memory->header;
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
  if (!run_.IsFixed()) {
    const CallTimes times = MeasureCalls();
    run_.header->plain_call_ticks = times.plain;
    run_.header->write_form_ticks = times.write_form;
    run_.header->read_form_ticks = times.read_form;
  }
  run_.header->is_unprivileged = run_.is_unprivileged ? 1 : 0;
  run_.header->preempts = run_.SendsToGates() || SpinWaits::AsksThreads(run_) ? 1 : 0;
  run_.header->has_brokers = run_.has_brokers ? 1 : 0;
  run_.header->notes_activity = all_.answers.is_open() ? 1 : 0;
  run_.header->names_by_robot = run_.scenario.network.has_value() ? 1 : 0;
  return {};
}

// Under set costs 1 GHz, the same on each host. Else the host's to the megahertz, for programs that
// ask the processor or /proc/cpuinfo for it.
std::uint64_t Setup::CounterRate() const {
  const double mhz = run_.IsFixed() ? 1000 : std::round(all_.clock.rate().ticks_per_ns * 1000);
  return static_cast<std::uint64_t>(mhz * 4294967296 / 1000);
}

// The seed of the next robot.
std::optional<std::uint64_t> Setup::TurnsSeed() const {
  if (!run_.IsFixed()) return std::nullopt;
  return run_.scenario.seed * 0x9e3779b97f4a7c15 + run_.robots.size();
}

// Under callback the world stands still while programs compute, whatever that takes.
PriceList Setup::PricesOf(const RobotSpec& spec) const {
  if (spec.is_ideal || run_.IsCallback()) return NoPrices();
  return spec.prices_are_hosts ? spec.prices.On(spec.speed) : spec.prices;
}

void Setup::MakeRobots() {
  for (const RobotSpec& spec : run_.scenario.robots) {
    const auto cores = static_cast<std::uint32_t>(spec.cores);
    Robot& robot = run_.robots.emplace_back(
        spec.name, spec.speed,
        RobotScheduler(
            cores, !run_.IsCallback(),
            [this](int order) { return all_.waker.WaitOf(run_.table.At(order)); }, TurnsSeed()));
    robot.number = static_cast<std::uint32_t>(run_.robots.size());
    robot.is_ideal = spec.is_ideal;
    robot.is_ours = spec.is_ours;
    robot.outside_speed = spec.outside_speed;
    if (spec.wakeup.median > VirtualDuration() && !run_.IsCallback()) {
      robot.wakeup = WakeupLatency(spec.wakeup.median, spec.wakeup.p99, run_.scenario.seed);
    }
    robot.prices = PricesOf(spec);
    for (std::uint32_t core = 0; core < cores; ++core) {
      VirtualCpu& cpu = run_.cpus.emplace_back();
      cpu.robot = &robot;
      cpu.core = core;
      cpu.leaf = run_.root.AddLeaf(static_cast<int>(robot.number));
      robot.cpus.push_back(&cpu);
    }
  }
  if (all_.network.present()) {
    all_.network_leaf.Join(static_cast<int>(run_.robots.size()) + 1);
  }
  all_.outside_leaf.Join(static_cast<int>(run_.robots.size()) + 2);
}

std::string Setup::PrepareHostCpu() {
  std::unique_ptr<Meter> meter;
  if (run_.IsFixed()) {
    meter = std::make_unique<FixedMeter>(PatienceOf(run_.scenario).silent);
  } else if (run_.is_unprivileged) {
    meter = std::make_unique<SharedCpuMeter>(all_.clock.rate());
  } else {
    meter = std::make_unique<MeasuredMeter>(all_.clock.rate());
  }
  if (std::string error = all_.host_cpu.Open(std::move(meter)); !error.empty()) return error;
  // As with any other process of ours.
  if (const int error = WhyNoLooksInto(all_.host_cpu.detector().pid()); error != 0) {
    return fmt::format(
        "tcsim may not read the memory of its own processes here ({}), so it cannot see what "
        "programs wait for; `tcsim doctor` says how to allow it",
        strerror(error));
  }
  all_.reactor.Add(all_.host_cpu.detector().fired_fd(), EPOLLIN, {Tag::kDetector});
  all_.reactor.Add(all_.host_cpu.detector().end_fd(), EPOLLIN, {Tag::kDetectorEnd});
  std::vector<pid_t> own = GuardsOf(getpid());
  own.insert(own.end(), {getpid(), all_.host_cpu.detector().pid()});
  all_.guard.Guard(std::move(own), [this](pid_t pid) { return run_.table.IsBroker(pid); });
  return {};
}

// Names the parts that keep something for a thread that waits.
void Setup::TellOfWaits() {
  all_.waker.Tell({
      .began_by_signal =
          [this](Task& task) {
            all_.signal_wakes.EndAwait(task, SignalsOf(run_, task), {task.reached});
          },
      .left =
          [this](Task& task, Wait& left) {
            if (const auto* descriptors = left.As<awaited::Descriptors>())
              all_.descriptors.Leave(*descriptors);
            CallFiles::Keep(task, left);
            all_.words.table().Leave(task.order);
            all_.objects.Leave(task);
            all_.inheritance.Leave(task);
          },
      .ends_in_trapped_call =
          [this](Task& task, shm::WakeReason reason) { all_.trapped_waits.Finish(task, reason); },
      .deliverer_is_held_up =
          [this](const Process& process, EventTime when) {
            all_.dds.ReleaseThoseAwaitingDeliverer(process, when);
          },
      .does_nothing_before = [this](const VirtualCpu& cpu) { return all_.ahead.EndOfDebt(cpu); },
  });
}

void Setup::TellOfEnds() {
  all_.thread_exit.Tell({
      .settle = [this](Task& task) { all_.settler.Settle(task); },
      .thread_ends = [this](Task& task, EventTime when) { all_.shared_events.PassOn(task, when); },
      .thread_has_ended =
          [this](Task& task) {
            all_.beside.Forget(task);
            all_.objects.Forget(task);
            all_.ahead.Forget(task);
            all_.registration.Forget(task);
            task.kept.reset();
          },
      .wake_those_waiting_for =
          [this](Task& task, EventTime when) { all_.locks.WakeThoseWaitingFor(task, when); },
      .child_has_ended =
          [this](Process& parent, pid_t child, EventTime when) {
            all_.stops.ChildChanged(parent, child, false, when);
          },
      .process_has_ended =
          [this](Process& process, EventTime when) {
            if (process.is_client) all_.launches.ClientHasEnded(process);
            if (process.is_client && process.robot->is_ours && !run_.IsInGrace()) {
              run_.Warn(fmt::format(
                  "tcs-dds-gateway has ended at {:.3f} s, so from then on programs whose DDS uses "
                  "sockets have no sensors, clock and commands of the type dds; what it has said "
                  "on stderr says why",
                  when.at.seconds()));
            }
            all_.objects.WakeAll(when);
            all_.dds.Leave(process, when);
          },
  });
}

}  // namespace tcs
