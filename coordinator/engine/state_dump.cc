#include "coordinator/engine/state_dump.h"

#include <fmt/format.h>
#include <sched.h>
#include <unistd.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>
#include <vector>

#include "coordinator/tasks/wait_text.h"

namespace tcs {

namespace {

using Json = nlohmann::ordered_json;

// Never is null.
Json Ns(VirtualTime time) { return time.IsNever() ? Json(nullptr) : Json(time.ns()); }

const char* NameOfPolicy(int policy) {
  switch (policy) {
    case SCHED_FIFO:
      return "SCHED_FIFO";
    case SCHED_RR:
      return "SCHED_RR";
    case SCHED_BATCH:
      return "SCHED_BATCH";
    case SCHED_IDLE:
      return "SCHED_IDLE";
    case SCHED_DEADLINE:
      return "SCHED_DEADLINE";
    default:
      return "SCHED_OTHER";
  }
}

const char* NameOfGate(std::uint32_t gate) {
  switch (gate) {
    case shm::kGateClosed:
      return "closed";
    case shm::kGateOpen:
      return "open";
    default:
      return "waiting";  // in the kernel, for it to be opened
  }
}

// A look at the run.
class Look {
 public:
  Look(const StateDump::Sources& from, std::uint64_t now_tsc)
      : from_(from), run_(from.run), now_tsc_(now_tsc) {}

  Json Run(int host_cpu) const {
    const RunOptions& options = run_.options;
    return {{"coordinator", getpid()},
            {"folder", options.output_directory},
            {"scenario", run_.scenario.path},
            {"accounting", run_.IsFixed() ? "fixed" : "measured"},
            {"sync", run_.IsCallback() ? "callback" : "consistent"},
            {"levels", !run_.is_unprivileged},
            {"host_cpu", host_cpu},
            {"real_ns", from_.clock.NsAt(now_tsc_)}};
  }

  Json Time() const {
    VirtualTime furthest = from_.world.present() ? from_.world.progress() : VirtualTime();
    for (const VirtualCpu& cpu : run_.cpus) furthest = std::max(furthest, cpu.progress);
    VirtualTime now = run_.latest;
    if (const auto clock = RunningClock(); clock && !run_.IsCallback()) {
      now = std::max(now, RobotTime(std::min(clock->time_ns, clock->horizon_ns)));
    }
    Json time = {{"virtual_ns", now.ns()},
                 {"furthest_ns", furthest.ns()},
                 {"next_ns", Ns(run_.root.Least())},
                 {"end_ns", Ns(run_.end)},
                 {"drift_ns", run_.Drift().ns()},
                 {"drift_bound_ns", run_.scenario.drift_bound.ns()},
                 {"dispatches", run_.report.switches},
                 {"ends", run_.IsInGrace()}};
    if (from_.pacing.IsOn()) {
      const Pacer& pacer = from_.pacing.pacer();
      time["pace"] = pacer.pace();
      time["paused"] = pacer.stands();
      time["behind_pace_ns"] = (pacer.behind() + pacer.account().given_up).ns();
    }
    return time;
  }

  Json WorldState() const {
    const World& world = from_.world;
    if (!world.present()) return nullptr;
    // Of the slowest virtual CPU that has something to do.
    const VirtualTime least = run_.root.Least();
    Json on_the_way = Json::array();
    for (const auto& [sensor, count] : world.KeptReadings()) {
      on_the_way.push_back({{"sensor", run_.scenario.sensors[sensor].name}, {"readings", count}});
    }
    return {{"progress_ns", world.progress().ns()},
            {"lead_ns", least.IsNever() ? Json(nullptr) : Json((world.progress() - least).ns())},
            {"next_stop_ns", Ns(world.NextStop())},
            {"next_output_ns", Ns(world.NextOutput())},
            {"samples", world.samples()},
            {"commands", world.commands()},
            {"commands_kept", world.kept_commands()},
            {"readings_on_the_way", std::move(on_the_way)},
            {"host_ns", world.host_ns()}};
  }

  // Which thread runs on which processor of the host.
  Json HostCpus(int host_cpu) const {
    Json home = {{"cpu", host_cpu}, {"thread", nullptr}};
    if (const Task* task = run_.turn.task(); task != nullptr) {
      home["thread"] = task->tid;
      home["since_host_ns"] = HostNsSince(from_.link.dispatched_tsc());
      home["horizon_ns"] = Ns(run_.turn.horizon());
    }
    Json cpus = Json::array({std::move(home)});
    for (const FurtherCpu& cpu : from_.ahead.cpus()) {
      const HostThread* thread = cpu.thread();
      cpus.push_back({{"cpu", cpu.cpu()},
                      {"thread", thread == nullptr ? Json(nullptr) : Json(thread->tid)},
                      {"ahead", true}});
    }
    return cpus;
  }

  Json Robots() const {
    Json robots = Json::array();
    for (const Robot& robot : run_.robots) {
      Json cores = Json::array();
      for (const VirtualCpu* cpu : robot.cpus) cores.push_back(Core(*cpu));
      Json processes = Json::array();
      for (const Process& process : run_.table.processes()) {
        if (process.robot == &robot && !process.dead) processes.push_back(ProcessState(process));
      }
      Json to_start = Json::array();
      for (const Launches::Launch& launch : from_.launches.all()) {
        if (launch.robot != &robot || launch.process != nullptr) continue;
        to_start.push_back({{"client", launch.spec->name},
                            {"at_ns", Ns(launch.start)},
                            {"after", launch.spec->after}});
      }
      robots.push_back({{"name", robot.name},
                        {"speed", robot.speed},
                        {"ideal", robot.is_ideal},
                        {"cores", std::move(cores)},
                        {"processes", std::move(processes)},
                        {"to_start", std::move(to_start)}});
    }
    return robots;
  }

  // The queues in which several threads wait, in the order in which the threads are woken.
  Json Queues() const {
    Json futexes = Json::array();
    for (const FutexKey& word : from_.futexes.AwaitedWords()) {
      futexes.push_back({{"process", word.pid},
                         {"file", word.file},
                         {"address", word.address},
                         {"waiters", Tids(from_.futexes.ByUrgency(word))}});
    }
    Json objects = Json::array();
    for (const KernelObject& object : from_.objects.AwaitedObjects()) {
      objects.push_back({{"kind", object.kind},
                         {"id", object.id},
                         {"waiters", Tids(from_.objects.WaitersFor(object))}});
    }
    Json dds = Json::array();
    for (const Process& process : run_.table.processes()) {
      if (process.dds_number == 0 || process.dead) continue;
      const dds::Hub::Backlog backlog = from_.hub.BacklogOf(process.dds_number);
      dds.push_back({{"process", process.pid},
                     {"messages", backlog.messages},
                     {"bytes", backlog.bytes},
                     {"due_ns", Ns(RobotTime(backlog.due_ns))},
                     {"full", from_.hub.IsFull(process.dds_number)},
                     {"delivering", from_.hub.IsDelivering(process.dds_number)}});
    }
    Json unregistered = Json::array();
    for (const auto& [pid, child] : from_.unregistered_children.living())
      unregistered.push_back(pid);
    return {
        {"futexes", std::move(futexes)},
        {"kernel_objects", std::move(objects)},
        {"dds", std::move(dds)},
        {"network_next_ns", from_.network.present() ? Ns(from_.network.NextDue()) : Json(nullptr)},
        {"unregistered_children", std::move(unregistered)}};
  }

 private:
  std::int64_t HostNsSince(std::uint64_t tsc) const {
    return now_tsc_ < tsc ? 0 : from_.clock.NsAt(now_tsc_) - from_.clock.NsAt(tsc);
  }

  // The value of a word may be the number of a thread, or something else.
  bool IsThread(pid_t tid) const { return tid > 0 && run_.table.Living(tid) != nullptr; }

  // The clock of the running thread; none where the clock is not known while the thread runs.
  std::optional<shm::ClockReading> RunningClock() const {
    if (!run_.turn.HasClock() || !from_.host_cpu.stands_still()) return std::nullopt;
    return from_.host_cpu.ClockOf(*run_.turn.task());
  }

  const Task& TaskAt(int order) const {
    return run_.table.tasks()[static_cast<std::size_t>(order)];
  }
  Json Tids(const std::vector<int>& orders) const {
    Json tids = Json::array();
    for (const int order : orders) tids.push_back(TaskAt(order).tid);
    return tids;
  }

  Json Core(const VirtualCpu& cpu) const {
    const RobotScheduler& scheduler = cpu.robot->scheduler;
    const RobotScheduler::Turn& next = scheduler.Next(cpu.core);
    const bool is_idle = next.thread == RobotScheduler::kNobody;
    return {{"core", cpu.core},
            {"progress_ns", cpu.progress.ns()},
            {"next_thread", is_idle ? Json(nullptr) : Json(TaskAt(next.thread).tid)},
            {"next_ns", Ns(scheduler.NextActionOf(cpu.core))},
            {"first", run_.root.First() == cpu.leaf}};
  }

  Json ProcessState(const Process& process) const {
    Json threads = Json::array();
    for (const Task* task : process.robot->tasks) {
      if (task->process == &process) threads.push_back(Thread(*task));
    }
    Json timers = Json::array();
    for (const ProcessTimers::Armed& timer : process.timers.AllArmed()) {
      const bool is_time = timer.kind.clock == shm::TimerClock::kTime;
      timers.push_back({{"id", timer.id},
                        {"clock", is_time ? "time" : "processor time"},
                        {"next_ns", timer.setting.next_ns},
                        {"interval_ns", timer.setting.interval_ns},
                        {"signal", timer.kind.signal}});
    }
    Json state = {{"pid", process.pid},
                  {"parent", process.parent},
                  {"client", process.client == nullptr ? "" : process.client->name},
                  {"is_client", process.is_client},
                  {"stopped", process.stopped},
                  {"unregistered_threads", process.has_unregistered_threads},
                  {"clock_lead_ns", process.clock.lead().ns()},
                  {"threads", std::move(threads)},
                  {"timers", std::move(timers)}};
    if (from_.pacing.IsOn() || process.killed) state["killed"] = process.killed;
    return state;
  }

  Json Thread(const Task& task) const {
    const SchedulingParameters& parameters = ParametersOf(task);
    const bool runs = run_.turn.IsOf(task);
    Json state = {{"tid", task.tid},
                  {"state", runs ? "running" : StateOf(task)},
                  {"text", TextOf(task)},
                  {"since_ns", task.reached.ns()},
                  {"until_ns", task.wait ? Ns(task.wait->deadline) : Json(nullptr)},
                  {"policy", NameOfPolicy(parameters.policy)},
                  {"priority", parameters.priority},
                  {"charged_ns", task.charged.ns()},
                  {"debt_ns", task.debt.ns()},
                  {"core", task.cpu == nullptr ? Json(nullptr) : Json(task.cpu->core)},
                  {"activations", task.activations},
                  {"at_gate", task.parked}};
    if (task.slot >= 0) {
      state["gate"] = NameOfGate(SlotOf(task).gate.load());
      if (const auto clock = runs ? RunningClock() : std::nullopt) {
        state["clock_ns"] = std::min(clock->time_ns, clock->horizon_ns);
        state["charged_ns"] = clock->cpu_ns;
      }
    }
    if (task.trap_id != 0) state["trapped_call"] = true;
    if (task.is_ahead) state["computes_ahead"] = true;
    if (task.owes_ahead) state["owes_ahead"] = true;
    if (const auto* futex = task.Awaits<awaited::Futex>(); futex != nullptr) {
      AddFutex(task, *futex, &state);
    }
    return state;
  }

  static const char* StateOf(const Task& task) {
    switch (task.state) {
      case TaskState::kStarting:
        return "starting";
      case TaskState::kReady:
        return "ready";
      case TaskState::kHolding:
        return "holding";
      case TaskState::kWaiting:
        return task.Awaits<awaited::Time>() != nullptr && !task.wait->deadline.IsNever()
                   ? "sleeping"
                   : "waiting";
      case TaskState::kUnseen:
        return "unseen";
      case TaskState::kDead:
        break;
    }
    return "ended";
  }

  // The text goes on after the thread's name.
  std::string TextOf(const Task& task) const {
    if (run_.turn.IsOf(task)) return "runs";
    switch (task.state) {
      case TaskState::kStarting:
        return "is being started";
      case TaskState::kReady:
        return task.debt > VirtualDuration() ? "is ready, once the time has passed that it owes"
                                             : "is ready";
      case TaskState::kHolding:
        return TextOfHold(task);
      case TaskState::kUnseen:
        return "is in a system call that the shim does not see";
      default:
        break;
    }
    if (!task.wait) return "has ended";
    if (task.Awaits<awaited::OthersRun>() != nullptr) {
      return "computes without a call, which takes no time here: it goes on once another thread "
             "has run";
    }
    if (task.Awaits<awaited::Nothing>() != nullptr) {
      return "is left where it is: its process is about to die, or the world goes on without it";
    }
    if (task.Awaits<awaited::Deliverer>() != nullptr) {
      return "waits until its process has taken the DDS messages that are due";
    }
    const bool has_deadline = !task.wait->deadline.IsNever();
    if (task.Awaits<awaited::Time>() != nullptr && has_deadline) return "sleeps";
    if (const auto* futex = task.Awaits<awaited::Futex>(); futex != nullptr) {
      return TextOfFutex(task, *futex);
    }
    return TextOfAwaited(task, run_.table.HasChild(*task.process)).text;
  }

  // Reads and writes wait until no other leaf can act at an earlier time.
  std::string TextOfHold(const Task& task) const {
    const bool reads = task.hold == shm::NotificationKind::kRead;
    const TemporalConsistency::Leaf first = run_.root.First();
    std::string whom = "the world";
    if (first >= 0 && static_cast<std::size_t>(first) >= run_.cpus.size()) {
      const bool is_network =
          run_.scenario.network.has_value() && static_cast<std::size_t>(first) == run_.cpus.size();
      whom = is_network ? "the network between the robots" : "what is outside of the run";
    } else if (first >= 0 && (task.cpu == nullptr || first != task.cpu->leaf)) {
      const VirtualCpu& cpu = run_.cpus[static_cast<std::size_t>(first)];
      whom = fmt::format("core {} of {}", cpu.core, cpu.robot->name);
    }
    return fmt::format("holds before it {}: {} can still act earlier", reads ? "reads" : "writes",
                       whom);
  }

  std::string TextOfFutex(const Task& task, const awaited::Futex& futex) const {
    if (futex.owner != awaited::kNobody) {
      return fmt::format("waits for a lock of thread {}, to which it lends its priority",
                         TaskAt(futex.owner).tid);
    }
    if (IsThread(futex.names_tid)) return fmt::format("waits for thread {}", futex.names_tid);
    return from_.futexes.WaitsForAny(task.order) ? "waits for one of several locks or conditions"
                                                 : "waits for a lock or a condition";
  }

  void AddFutex(const Task& task, const awaited::Futex& futex, Json* state) const {
    const FutexKey* word = from_.futexes.FirstWordOf(task.order);
    if (word == nullptr) return;
    Json& described = (*state)["futex"];
    described = {{"process", word->pid}, {"file", word->file}, {"address", word->address}};
    if (futex.owner != awaited::kNobody) described["owner"] = TaskAt(futex.owner).tid;
    if (IsThread(futex.names_tid)) described["owner"] = futex.names_tid;
  }

  const StateDump::Sources& from_;
  const RunState& run_;
  const std::uint64_t now_tsc_;
};

}  // namespace

std::string StateDump::Text(int host_cpu, std::uint64_t now_tsc) const {
  const Look look(from_, now_tsc);
  const Json state = {{"run", look.Run(host_cpu)},  {"time", look.Time()},
                      {"world", look.WorldState()}, {"host_cpus", look.HostCpus(host_cpu)},
                      {"robots", look.Robots()},    {"queues", look.Queues()}};
  return state.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace tcs
