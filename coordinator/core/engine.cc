#include "coordinator/core/engine.h"

#include <errno.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <pthread.h>
#include <signal.h>
#include <sys/epoll.h>
#include <sys/eventfd.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/signalfd.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/timerfd.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>

namespace tcs {

namespace {

// How far a virtual CPU may run past what others could send to a more urgent thread on it.
constexpr std::int64_t kGrainNs = 100'000;
constexpr std::int64_t kQuantumNs = 1'000'000;  // of equals on one virtual CPU
// Deterministic runs begin on 2024-01-01T00:00:00Z.
constexpr std::int64_t kFixedDateNs = 1'704'067'200'000'000'000;
constexpr std::int64_t kMonotonicStartNs = 1'000'000'000'000;

std::int64_t HostNs(clockid_t id) {
  timespec t;
  clock_gettime(id, &t);
  return t.tv_sec * 1'000'000'000 + t.tv_nsec;
}

struct DetectorFds {
  int arm, fired;
};

// Runs exactly when armed and neither the coordinator nor the active thread wants the CPU.
void* DetectorThread(void* raw) {
  const DetectorFds fds = *static_cast<DetectorFds*>(raw);
  delete static_cast<DetectorFds*>(raw);
  SetLevel(0, Level::kDetector);
  std::uint64_t count = 0;
  const std::uint64_t one = 1;
  while (read(fds.arm, &count, sizeof count) == sizeof count) {
    if (write(fds.fired, &one, sizeof one) != sizeof one) break;
  }
  return nullptr;
}

}  // namespace

Engine::Engine(const Scenario& scenario, const RunOptions& options)
    : scenario_(scenario), options_(options) {}

Engine::~Engine() {
  for (const int fd : {memfd_, epoll_, pipe_[0], pipe_[1], timer_, listener_, signals_}) {
    if (fd >= 0) close(fd);
  }
}

void Engine::Warn(const std::string& text) {
  if (std::find(report_.warnings.begin(), report_.warnings.end(), text) == report_.warnings.end()) {
    report_.warnings.push_back(text);
  }
}

std::string Engine::Prepare() {
  const std::string csv =
      options_.output_directory.empty() ? "" : options_.output_directory + "/bodies.csv";
  if (std::string error = world_.Open(scenario_, csv); !error.empty()) return error;
  if (std::string error = EnterRealTime(); !error.empty()) return error;
  ns_per_tick_q32_ = CalibrateTsc();
  prctl(PR_SET_CHILD_SUBREAPER, 1);

  memfd_ = memfd_create("tcs", MFD_CLOEXEC);
  if (memfd_ < 0 || fchmod(memfd_, 0600) != 0 || ftruncate(memfd_, shm::kSegmentSize) != 0) {
    return "the shared memory cannot be made";
  }
  void* at = mmap(nullptr, shm::kSegmentSize, PROT_READ | PROT_WRITE, MAP_SHARED, memfd_, 0);
  if (at == MAP_FAILED) return "the shared memory cannot be mapped";
  header_ = static_cast<shm::SegmentHeader*>(at);
  const bool fixed = options_.accounting == shm::Accounting::kFixed;
  header_->magic = shm::kMagic;
  header_->version = shm::kVersion;
  header_->header_size = sizeof(shm::SegmentHeader);
  header_->slot_size = sizeof(shm::ThreadSlot);
  header_->slot_count = shm::kSlotCount;
  header_->accounting = options_.accounting;
  header_->monotonic_offset_ns = kMonotonicStartNs;
  header_->realtime_offset_ns = fixed ? kFixedDateNs : HostNs(CLOCK_REALTIME);
  header_->coordinator_pid = getpid();

  epoll_ = epoll_create1(EPOLL_CLOEXEC);
  if (pipe2(pipe_, O_CLOEXEC | O_NONBLOCK) != 0) return "no pipe can be made";
  fcntl(pipe_[1], F_SETFL, 0);
  timer_ = timerfd_create(CLOCK_MONOTONIC, TFD_CLOEXEC | TFD_NONBLOCK);
  sigset_t blocked;
  sigemptyset(&blocked);
  sigaddset(&blocked, SIGTERM);
  sigaddset(&blocked, SIGHUP);
  if (!options_.output_directory.empty()) sigaddset(&blocked, SIGINT);
  sigprocmask(SIG_BLOCK, &blocked, nullptr);
  if (options_.output_directory.empty()) signal(SIGINT, SIG_IGN);
  signal(SIGPIPE, SIG_IGN);
  signals_ = signalfd(-1, &blocked, SFD_CLOEXEC | SFD_NONBLOCK);

  listener_ = socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  socket_name_ = fmt::format("tcs.{}.{:x}", getpid(), HostNs(CLOCK_MONOTONIC));
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  memcpy(address.sun_path + 1, socket_name_.data(), socket_name_.size());
  const auto size =
      static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + socket_name_.size());
  if (bind(listener_, reinterpret_cast<sockaddr*>(&address), size) != 0 ||
      listen(listener_, 256) != 0) {
    return "the socket that clients register at cannot be made";
  }
  Watch(pipe_[0], EPOLLIN, Tag::kPipe, 0);
  Watch(timer_, EPOLLIN, Tag::kTimer, 0);
  Watch(listener_, EPOLLIN, Tag::kListener, 0);
  Watch(signals_, EPOLLIN, Tag::kSignal, 0);
  for (std::size_t i = 0; i < world_.command_fds().size(); ++i) {
    Watch(world_.command_fds()[i], EPOLLIN, Tag::kCommand, static_cast<std::uint32_t>(i));
  }
  detector_arm_ = eventfd(0, EFD_CLOEXEC);
  detector_fired_ = eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
  Watch(detector_fired_, EPOLLIN, Tag::kDetector, 0);
  pthread_t detector;
  if (pthread_create(&detector, nullptr, DetectorThread,
                     new DetectorFds{detector_arm_, detector_fired_}) != 0) {
    return "the block detector's thread cannot be made";
  }
  pthread_detach(detector);
  return {};
}

std::string Engine::StartClients() {
  for (const RobotSpec& robot : scenario_.robots) {
    const std::size_t first = cpus_.size();
    for (int core = 0; core < robot.cores; ++core) {
      VirtualCpu& cpu = cpus_.emplace_back();
      cpu.robot = robot.name;
      cpu.core = static_cast<std::uint32_t>(core);
      cpu.cores = static_cast<std::uint32_t>(robot.cores);
      cpu.order = static_cast<int>(cpus_.size());
      cpu.speed = robot.speed;
    }
    for (std::size_t i = 0; i < robot.clients.size(); ++i) {
      const ClientSpec& client = robot.clients[i];
      SpawnRequest request;
      request.command = client.command;
      request.working_directory = client.working_directory;
      request.environment = client.environment;
      request.environment["LD_PRELOAD"] = options_.preload_library;
      request.environment["TCS_SOCKET"] = socket_name_;
      request.fixed_layout = options_.accounting == shm::Accounting::kFixed;
      if (!options_.output_directory.empty()) {
        std::string base = client.name;
        std::replace(base.begin(), base.end(), '/', '-');
        base = options_.output_directory + "/" + base;
        request.log_stdout = base + ".out.log";
        request.log_stderr = base + ".err.log";
      }
      const pid_t pid = Spawn(request);
      if (pid < 0) return client.name + " cannot be started: " + strerror(errno);
      VirtualCpu* cpu = &cpus_[first + i % static_cast<std::size_t>(robot.cores)];
      Task* task = NewTask(pid, getpid(), cpu, client.name, client.priority);
      task->process->is_client = true;
      task->process->call_cost_ns = client.fixed_call_cost.ns();
    }
  }
  return {};
}

bool Engine::IsRunnable(const Task& task) const {
  return task.state == TaskState::kReady || task.state == TaskState::kHolding ||
         task.state == TaskState::kStarting;
}

std::int64_t Engine::NextTime(const VirtualCpu& cpu) const {
  std::int64_t next = shm::kNeverNs;
  for (const Task* task : cpu.tasks) {
    if (IsRunnable(*task)) return cpu.progress_ns;
    if (task->state == TaskState::kWaiting) next = std::min(next, task->deadline_ns);
    if (task->state == TaskState::kDead) continue;
    for (const auto& [id, timer] : task->process->timers) {
      if (timer.next_ns != 0) next = std::min(next, timer.next_ns);
    }
  }
  return next == shm::kNeverNs ? next : std::max(next, cpu.progress_ns);
}

std::int64_t Engine::OthersNext(const VirtualCpu& cpu) const {
  std::int64_t next = shm::kNeverNs;
  for (const VirtualCpu& other : cpus_) {
    if (&other != &cpu) next = std::min(next, NextTime(other));
  }
  return next;
}

std::int64_t Engine::ReadSafe(const VirtualCpu& cpu) const {
  const std::int64_t output = world_.present() ? world_.NextOutputNs() : shm::kNeverNs;
  // What the dynamics send at an instant is there for a read at that instant.
  return std::min(OthersNext(cpu), output == shm::kNeverNs ? output : output - 1);
}

bool Engine::IsSafe(const Task& task) const {
  if (task.state != TaskState::kHolding) return true;
  const VirtualCpu& cpu = *task.cpu;
  const std::int64_t safe =
      task.hold == shm::NotificationKind::kRead ? ReadSafe(cpu) : OthersNext(cpu);
  return cpu.progress_ns <= safe;
}

Task* Engine::Pick(const VirtualCpu& cpu) const {
  Task* best = nullptr;
  for (Task* task : cpu.tasks) {
    if (!IsRunnable(*task)) continue;
    if (best == nullptr || task->priority > best->priority ||
        (task->priority == best->priority && task->ready_number < best->ready_number)) {
      best = task;
    }
  }
  return best;
}

VirtualCpu* Engine::PickCpu() {
  VirtualCpu* best = nullptr;
  std::int64_t best_next = shm::kNeverNs;
  for (VirtualCpu& cpu : cpus_) {
    const std::int64_t next = NextTime(cpu);
    if (next >= best_next) continue;
    if (const Task* task = Pick(cpu); task != nullptr && !IsSafe(*task)) continue;
    best = &cpu;
    best_next = next;
  }
  return best;
}

void Engine::FireDue(VirtualCpu& cpu) {
  event_ns_ = cpu.progress_ns;
  bool wrote = false;
  for (Task* task : cpu.tasks) {
    if (task->state == TaskState::kDead) continue;
    if (task->state == TaskState::kWaiting && task->deadline_ns <= cpu.progress_ns) {
      MakeReady(*task, shm::WakeReason::kDeadline);
    }
    for (auto& [id, timer] : task->process->timers) {
      if (timer.next_ns == 0 || timer.next_ns > cpu.progress_ns) continue;
      std::uint64_t count = 1;
      if (timer.interval_ns > 0) {
        count += static_cast<std::uint64_t>((cpu.progress_ns - timer.next_ns) / timer.interval_ns);
        timer.next_ns += static_cast<std::int64_t>(count) * timer.interval_ns;
      } else {
        timer.next_ns = 0;
      }
      if (timer.event_fd >= 0) {
        wrote |= write(timer.event_fd, &count, sizeof count) == sizeof count;
      } else {
        // A thread that the kernel holds (sigsuspend, pause) is woken by the signal itself.
        if (task->state == TaskState::kUnseen) {
          kill(task->process->pid, SIGALRM);
          continue;
        }
        task->process->alarm_pending = true;
        if (task->state == TaskState::kWaiting) MakeReady(*task, shm::WakeReason::kSignal);
      }
    }
  }
  if (wrote) PollEvents(0);
}

std::int64_t Engine::HorizonFor(const Task& task, std::int64_t* idle_until) const {
  const VirtualCpu& cpu = *task.cpu;
  std::int64_t limit = end_ns_;
  const std::int64_t others = OthersNext(cpu);
  const std::int64_t drift = scenario_.drift_bound.ns();
  if (others != shm::kNeverNs) limit = std::min(limit, others + drift);
  if (world_.present()) limit = std::min(limit, world_.progress_ns() + drift);
  limit = std::min(limit, cpu.progress_ns + shm::kMaxDispatchNs - 1);
  std::int64_t idle = limit;
  for (const Task* other : cpu.tasks) {
    if (other->state == TaskState::kDead) continue;
    for (const auto& [id, timer] : other->process->timers) {
      if (timer.next_ns == 0) continue;
      if (other == &task || other->priority > task.priority) limit = std::min(limit, timer.next_ns);
      idle = std::min(idle, timer.next_ns);
    }
    if (other == &task) continue;
    if (other->state == TaskState::kWaiting) {
      if (other->priority > task.priority) {
        limit = std::min(limit, other->deadline_ns);
        if (other->waits_for_fds) {
          limit = std::min(limit, std::max(ReadSafe(cpu), cpu.progress_ns + kGrainNs));
        }
      }
      idle = std::min(idle, other->deadline_ns);
    } else {
      idle = 0;
      if (other->priority == task.priority && IsRunnable(*other)) {
        limit = std::min(limit, cpu.progress_ns + kQuantumNs);
      }
    }
  }
  *idle_until = std::min(idle, limit);
  return limit;
}

void Engine::NoteDrift() {
  std::int64_t most = world_.present() ? world_.progress_ns() : 0;
  std::int64_t least = world_.present() ? world_.progress_ns() : shm::kNeverNs;
  for (const VirtualCpu& cpu : cpus_) {
    most = std::max(most, cpu.progress_ns);
    least = std::min(least, NextTime(cpu));
  }
  if (least != shm::kNeverNs) report_.drift_ns = std::max(report_.drift_ns, most - least);
}

void Engine::StepCpu(VirtualCpu& cpu) {
  cpu.progress_ns = std::max(cpu.progress_ns, NextTime(cpu));
  FireDue(cpu);
  Task* task = Pick(cpu);
  if (task == nullptr || !IsSafe(*task)) return;
  std::int64_t idle_until = 0;
  const std::int64_t horizon = HorizonFor(*task, &idle_until);
  if (task->state != TaskState::kStarting && cpu.progress_ns + task->debt_ns >= horizon) {
    task->debt_ns -= horizon - cpu.progress_ns;
    cpu.progress_ns = std::max(cpu.progress_ns, horizon);
    NoteDrift();
    return;
  }
  Dispatch(*task, horizon, idle_until);
  NoteDrift();
}

// A thread that blocked where the shim could not see it is runnable again once the kernel says so.
void Engine::PollUnseen() {
  for (Task& task : tasks_) {
    if (task.state != TaskState::kUnseen || ThreadState(task.tid) != 'R') continue;
    event_ns_ = std::max(event_ns_, task.cpu->progress_ns);
    MakeReady(task, shm::WakeReason::kGo);
    task.parked = false;
  }
}

void Engine::WaitOutside() {
  const bool unseen = std::any_of(tasks_.begin(), tasks_.end(), [](const Task& task) {
    return task.state == TaskState::kUnseen || task.waits_for_child;
  });
  PollEvents(unseen ? 1 : 200);
}

RunReport Engine::Run() {
  report_.error = Prepare();
  if (report_.error.empty()) report_.error = StartClients();
  const std::int64_t start = HostNs(CLOCK_MONOTONIC);
  const std::int64_t cpu_start = HostNs(CLOCK_THREAD_CPUTIME_ID);
  end_ns_ = scenario_.duration.ns();
  while (report_.error.empty() && !stop_requested_) {
    const bool alive = std::any_of(tasks_.begin(), tasks_.end(),
                                   [](const Task& task) { return task.state != TaskState::kDead; });
    if (!alive) break;
    PollUnseen();
    std::int64_t least = shm::kNeverNs;
    for (const VirtualCpu& cpu : cpus_) least = std::min(least, NextTime(cpu));
    if (world_.present()) {
      const std::int64_t limit = std::min(least, end_ns_);
      const std::int64_t now = world_.progress_ns();
      if (now < limit || world_.NextOutputNs() <= std::min(now, limit)) {
        event_ns_ = std::max(event_ns_, now);
        if (world_.Advance(limit)) {
          event_ns_ = world_.progress_ns();
          PollEvents(0);
        }
        NoteDrift();
        continue;
      }
    }
    if (least >= end_ns_ && least != shm::kNeverNs) break;
    if (least == shm::kNeverNs && world_.present()) break;
    VirtualCpu* cpu = PickCpu();
    if (cpu == nullptr) {
      WaitOutside();
      continue;
    }
    // Before idle time is jumped over: is something from outside already there?
    if (Pick(*cpu) == nullptr) {
      external_event_ = false;
      PollEvents(0);
      PollUnseen();
      if (external_event_) continue;
      cpu = PickCpu();
      if (cpu == nullptr) continue;
    }
    StepCpu(*cpu);
  }
  report_.real_ns = HostNs(CLOCK_MONOTONIC) - start;
  report_.coordinating_ns =
      HostNs(CLOCK_THREAD_CPUTIME_ID) - cpu_start - (world_.present() ? world_.host_ns() : 0);
  if (header_ != nullptr) Shutdown();
  Report(&report_);
  return report_;
}

void Engine::Shutdown() {
  header_->shutdown.store(1);
  for (Task& task : tasks_) {
    if (task.state == TaskState::kDead) continue;
    const std::int64_t cpu = ThreadCpuClockNs(task.tid, task.process->threads == 1);
    if (cpu >= 0 && task.host_origin_ns >= 0) task.host_cpu_ns = cpu - task.host_origin_ns;
    kill(task.process->pid, SIGKILL);
  }
  // Everything that descends from this process and lost its parent is ours to end.
  for (int turn = 0; turn < 200; ++turn) {
    int status = 0;
    const pid_t pid = waitpid(-1, &status, WNOHANG);
    if (pid < 0) break;
    if (pid == 0) usleep(5'000);
  }
}

void Engine::Report(RunReport* report) {
  report->virtual_ns = world_.present() ? world_.progress_ns() : 0;
  for (const VirtualCpu& cpu : cpus_) {
    report->virtual_ns = std::max(report->virtual_ns, cpu.progress_ns);
  }
  report->dynamics_ns = world_.host_ns();
  report->samples = world_.samples();
  report->commands = world_.commands();
  report->client_ns = client_host_ns_;
  for (Task& task : tasks_) {
    if (!task.process->is_client || task.slot < 0) continue;
    ClientReport client;
    client.name = task.process->name;
    client.charged_ns = task.charged_ns;
    client.stolen_ns = Slot(task).clock.stolen_ns.load();
    client.activations = task.activations;
    client.host_cpu_ns = task.host_cpu_ns;
    report->clients.push_back(client);
  }
}

RunReport RunScenario(const Scenario& scenario, const RunOptions& options) {
  return Engine(scenario, options).Run();
}

}  // namespace tcs
