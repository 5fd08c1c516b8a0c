// What a run needs before its first step: the run's memory, the sockets that clients find us by,
// the processor that they run on.
#include <errno.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <sys/epoll.h>
#include <sys/prctl.h>
#include <sys/signalfd.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <time.h>
#include <unistd.h>

#include <cstring>
#include <memory>
#include <new>
#include <utility>

#include "coordinator/core/engine.h"
#include "coordinator/core/scheduling_rights.h"
#include "coordinator/host/fixed_meter.h"
#include "coordinator/host/measured_meter.h"
#include "coordinator/host/shared_cpu_meter.h"
#include "coordinator/os/cpu_claim.h"
#include "coordinator/os/guardian.h"
#include "coordinator/os/host.h"
#include "coordinator/os/shared_memory.h"
#include "shm/check.h"

namespace tcs {

namespace {

// Deterministic runs begin on 2024-01-01T00:00:00Z.
constexpr std::int64_t kFixedDateNs = 1'704'067'200'000'000'000;

}  // namespace

std::string Engine::Prepare() {
  // What refuses the run comes first: before others are waited for, and before an earlier run's
  // results are written over.
  if (gates_only_ && !TrapsHoldSignals()) {
    return WhyNoRealTime() + ", and to run without it takes Linux 5.19 or newer";
  }
  if (std::string error = world_.Open(scenario_); !error.empty()) return error;
  std::string taken;
  claim_ = ClaimCpu(options_.waits_for_cpu, &taken);
  if (!taken.empty()) return taken;
  ClientsRunOn(claim_.cpu);
  if (std::string error = BindTo(claim_.cpu); !error.empty()) return error;
  if (gates_only_) {
    IgnoreRealTimeLimits();
    BeWokenInTime();
    if (options_.on_notice) {
      options_.on_notice(
          "SCHED_FIFO is not permitted here, so that gates keep the threads apart: the run takes "
          "longer (`tcsim doctor` says more)");
    }
  } else {
    if (!SetLevel(0, Level::kCoordinator)) return "the coordinator's priority cannot be set";
  }
  if (std::string error = OpenRecords(); !error.empty()) return error;
  if (std::string error = PrepareFolders(); !error.empty()) return error;
  if (world_.present()) {
    world_row_ = schedule_.AddRow("dynamics", "dynamics");
  }
  ns_per_tick_q32_ = CalibrateTsc();
  ticks_per_ns_ = 4294967296.0 / static_cast<double>(ns_per_tick_q32_);
  prctl(PR_SET_CHILD_SUBREAPER, 1);
  RegisterHandlers();
  if (std::string error = PrepareMemory(); !error.empty()) return error;
  if (std::string error = OpenDds(); !error.empty()) return error;
  if (world_.present()) root_.UpdateDynamics(world_.progress_ns(), world_.NextOutputNs());
  if (std::string error = PrepareListener(); !error.empty()) return error;
  for (std::size_t i = 0; i < world_.command_fds().size(); ++i) {
    reactor_.Add(world_.command_fds()[i], EPOLLIN, {Tag::kCommand, static_cast<std::uint32_t>(i)});
  }
  return PrepareHostCpu();
}

std::string Engine::PrepareMemory() {
  SharedMemory memory = MakePublishedMemory("tcs-run", sizeof(shm::RunMemory));
  if (!memory.fd) return fmt::format("the shared memory cannot be made: {}", strerror(errno));
  memfd_ = std::move(memory.fd);
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
  header_->gates_only = gates_only_ ? 1 : 0;
  header_->preempts = Preempts() ? 1 : 0;
  return {};
}

std::string Engine::PrepareListener() {
  sigset_t blocked;
  sigemptyset(&blocked);
  for (const int signal : {SIGTERM, SIGHUP, SIGINT}) sigaddset(&blocked, signal);
  sigprocmask(SIG_BLOCK, &blocked, nullptr);
  signal(SIGPIPE, SIG_IGN);
  signals_.Reset(signalfd(-1, &blocked, SFD_CLOEXEC | SFD_NONBLOCK));

  socket_name_ = fmt::format("tcs.{}.{:x}", getpid(), HostClockNs(CLOCK_MONOTONIC));
  reactor_.Add(signals_.get(), EPOLLIN, {Tag::kSignal});
  return {};
}

// Where the next client and its descendants register. Its name, or nothing if it cannot be made.
std::string Engine::OpenListener() {
  const auto client = static_cast<std::uint32_t>(listeners_.size());
  const std::string name = fmt::format("{}.{}", socket_name_, client);
  const int listener = socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (listener < 0) return {};
  listeners_.push_back({UniqueFd(listener), nullptr});
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  memcpy(address.sun_path + 1, name.data(), name.size());
  const auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + name.size());
  if (bind(listener, reinterpret_cast<sockaddr*>(&address), size) != 0 ||
      listen(listener, 256) != 0) {
    return {};
  }
  reactor_.Add(listener, EPOLLIN, {Tag::kListener, client});
  return name;
}

std::string Engine::PrepareHostCpu() {
  const TscRate rate{.ns_per_tick_q32 = ns_per_tick_q32_, .ticks_per_ns = ticks_per_ns_};
  std::unique_ptr<Meter> meter;
  if (IsFixed()) {
    meter = std::make_unique<FixedMeter>();
  } else if (gates_only_) {
    meter = std::make_unique<SharedCpuMeter>(rate);
  } else {
    meter = std::make_unique<MeasuredMeter>(rate);
  }
  if (std::string error = host_cpu_.Open(std::move(meter)); !error.empty()) return error;
  // As with any other process of ours.
  const UniqueFd pidfd(OpenPidfd(host_cpu_.detector().pid()));
  const UniqueFd fd(DuplicateFd(pidfd.get(), host_cpu_.detector().fired_fd()));
  if (!fd && (errno == EPERM || errno == ENOSYS)) {
    return fmt::format(
        "pidfd_getfd is refused here ({}), so that tcsim could not see when what programs wait for "
        "is ready; `tcsim doctor` says how to allow it",
        strerror(errno));
  }
  reactor_.Add(host_cpu_.detector().fired_fd(), EPOLLIN, {Tag::kDetector});
  reactor_.Add(host_cpu_.detector().end_fd(), EPOLLIN, {Tag::kDetectorEnd});
  guarded_ = GuardsOf(getpid());
  guarded_.insert(guarded_.end(), {getpid(), host_cpu_.detector().pid()});
  return {};
}

}  // namespace tcs
