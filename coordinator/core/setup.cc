// What a run needs before its first step: the run's memory, the socket that clients find us by,
// the block detector, the clients themselves.
#include <errno.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <sys/epoll.h>
#include <sys/eventfd.h>
#include <sys/prctl.h>
#include <sys/signalfd.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <new>

#include "coordinator/core/engine.h"
#include "coordinator/os/cpu_claim.h"
#include "coordinator/os/host.h"
#include "coordinator/os/shared_memory.h"

namespace tcs {

namespace {

// Deterministic runs begin on 2024-01-01T00:00:00Z.
constexpr std::int64_t kFixedDateNs = 1'704'067'200'000'000'000;

// Runs exactly when armed and neither the coordinator nor the active thread wants the CPU. A
// process of its own and not a thread: a killed coordinator must not have to wait for somebody who
// may never get the processor again before its death is known.
[[noreturn]] void Detect(int arm, int fired) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  SetLevel(0, Level::kDetector);
  constexpr int kArm = 0, kFired = 1;
  if (dup2(arm, kArm) == kArm && dup2(fired, kFired) == kFired) {
    close_range(2, ~0u, 0);
    std::uint64_t count = 0;
    const std::uint64_t one = 1;
    while (read(kArm, &count, sizeof count) == sizeof count) {
      if (write(kFired, &one, sizeof one) != sizeof one) break;
    }
  }
  _exit(0);
}

}  // namespace

std::string Engine::Prepare() {
  // What refuses the run comes first: before others are waited for, and before an earlier run's
  // results are written over.
  if (std::string error = WhyNoRealTime(); !error.empty()) return error;
  if (std::string error = world_.Open(scenario_); !error.empty()) return error;
  claim_ = ClaimCpu();
  if (std::string error = EnterRealTime(claim_.cpu); !error.empty()) return error;
  if (std::string error = OpenRecords(); !error.empty()) return error;
  if (world_.present()) {
    world_row_ = AddRow("dynamics", "dynamics");
  }
  ns_per_tick_q32_ = CalibrateTsc();
  ticks_per_ns_ = 4294967296.0 / static_cast<double>(ns_per_tick_q32_);
  prctl(PR_SET_CHILD_SUBREAPER, 1);
  AllowManyDescriptors();
  epoll_ = epoll_create1(EPOLL_CLOEXEC);
  if (std::string error = PrepareMemory(); !error.empty()) return error;
  if (std::string error = OpenDds(); !error.empty()) return error;
  if (world_.present()) root_.UpdateDynamics(world_.progress_ns(), world_.NextOutputNs());
  if (std::string error = PrepareListener(); !error.empty()) return error;
  for (std::size_t i = 0; i < world_.command_fds().size(); ++i) {
    Watch(world_.command_fds()[i], EPOLLIN, Tag::kCommand, static_cast<std::uint32_t>(i));
  }
  return PrepareDetector();
}

std::string Engine::PrepareMemory() {
  const SharedMemory memory = MakePublishedMemory("tcs-run", sizeof(shm::RunMemory));
  if (memory.fd < 0) return fmt::format("the shared memory cannot be made: {}", strerror(errno));
  memfd_ = memory.fd;
  memory_ = new (memory.at) shm::RunMemory{};
  header_ = &memory_->header;
  header_->magic = shm::kMagic;
  header_->version = shm::kVersion;
  header_->header_size = sizeof(shm::RunHeader);
  header_->slot_size = sizeof(shm::ThreadSlot);
  header_->slot_count = shm::kSlotCount;
  header_->accounting = options_.accounting;
  header_->sync = options_.sync;
  header_->monotonic_offset_ns = options_.uptime_ns;
  header_->realtime_offset_ns =
      options_.date_ns.value_or(IsFixed() ? kFixedDateNs : HostClockNs(CLOCK_REALTIME));
  header_->coordinator_pid = getpid();
  return {};
}

std::string Engine::PrepareListener() {
  sigset_t blocked;
  sigemptyset(&blocked);
  sigaddset(&blocked, SIGTERM);
  sigaddset(&blocked, SIGHUP);
  const bool has_terminal = options_.output_directory.empty();
  if (!has_terminal) sigaddset(&blocked, SIGINT);
  sigprocmask(SIG_BLOCK, &blocked, nullptr);
  // ^C is for the program that has the terminal.
  if (has_terminal) signal(SIGINT, SIG_IGN);
  signal(SIGPIPE, SIG_IGN);
  signals_ = signalfd(-1, &blocked, SFD_CLOEXEC | SFD_NONBLOCK);

  listener_ = socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  socket_name_ = fmt::format("tcs.{}.{:x}", getpid(), HostClockNs(CLOCK_MONOTONIC));
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  memcpy(address.sun_path + 1, socket_name_.data(), socket_name_.size());
  const auto size =
      static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + socket_name_.size());
  if (bind(listener_, reinterpret_cast<sockaddr*>(&address), size) != 0 ||
      listen(listener_, 256) != 0) {
    return "the socket that clients register at cannot be made";
  }
  Watch(listener_, EPOLLIN, Tag::kListener, 0);
  Watch(signals_, EPOLLIN, Tag::kSignal, 0);
  return {};
}

std::string Engine::PrepareDetector() {
  detector_arm_ = eventfd(0, EFD_CLOEXEC);
  detector_fired_ = eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
  Watch(detector_fired_, EPOLLIN, Tag::kDetector, 0);
  const pid_t coordinator = getpid();
  const pid_t detector = fork();
  if (detector < 0) return "the block detector's process cannot be made";
  detector_pid_ = detector;
  if (detector == 0) {
    if (getppid() != coordinator) _exit(0);
    Detect(detector_arm_, detector_fired_);
  }
  return {};
}

std::string Engine::StartClients() {
  for (const RobotSpec& robot : scenario_.robots) {
    const auto cores = static_cast<std::uint32_t>(robot.cores);
    Robot& computer = robots_.emplace_back(robot.name, cores, robot.speed);
    for (std::uint32_t core = 0; core < cores; ++core) {
      VirtualCpu& cpu = cpus_.emplace_back();
      cpu.robot = &computer;
      cpu.core = core;
      cpu.leaf = root_.AddLeaf(static_cast<int>(robots_.size()));
      computer.cpus.push_back(&cpu);
    }
    for (const ClientSpec& client : robot.clients) {
      SpawnRequest request;
      request.command = client.command;
      request.working_directory = client.working_directory;
      request.environment = client.environment;
      const bool charges_allocations = IsFixed() && client.fixed_allocation_cost.ns() > 0;
      request.environment["LD_PRELOAD"] =
          options_.preload_library + (charges_allocations ? ":" + options_.allocation_library : "");
      request.environment["TCS_SOCKET"] = socket_name_;
      request.fixed_layout = IsFixed();
      if (!options_.output_directory.empty()) {
        std::string base = client.name;
        std::replace(base.begin(), base.end(), '/', '-');
        base = options_.output_directory + "/" + base;
        request.log_stdout = base + ".out.log";
        request.log_stderr = base + ".err.log";
      }
      const Spawned spawned = Spawn(request);
      const pid_t pid = spawned.pid;
      if (pid < 0) return client.name + " cannot be started: " + strerror(errno);
      if (spawned.trap >= 0) {
        Watch(spawned.trap, EPOLLIN, Tag::kTrap, static_cast<std::uint32_t>(spawned.trap));
      } else {
        Warn("futex calls cannot be trapped here (" + std::string(strerror(errno)) +
             "): threads wait for each other in real time");
      }
      Task* task = NewTask(pid, getpid(), &computer, client.name, client.priority);
      task->process->is_client = true;
      task->process->call_cost_ns = client.fixed_call_cost.ns();
      task->process->allocation_cost_ns = client.fixed_allocation_cost.ns();
      task->process->patch_vdso = client.patch_vdso;
      task->process->dds_endpoints = client.dds == DdsTransport::kEndpoints;
    }
  }
  return {};
}

}  // namespace tcs
