// Trapped calls other than futex: made raw, or by the C library from inside, where no interposed
// symbol sees them. What they wait for is waited for here; then the kernel carries them out, and
// does not have to wait.
#include <errno.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <limits.h>
#include <poll.h>
#include <sys/epoll.h>
#include <sys/resource.h>
#include <sys/select.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <optional>
#include <vector>

#include "coordinator/core/engine.h"
#include "coordinator/os/host.h"
#include "coordinator/os/open_files.h"

namespace tcs {

namespace {

constexpr std::int64_t kNsPerSecond = 1'000'000'000;
constexpr std::size_t kMostPolled = 65'536, kSets = 3;
constexpr int kTimerAbsolute = 1;  // TIMER_ABSTIME

std::int64_t ToNs(const timespec& t) {
  constexpr std::int64_t kMostSeconds = shm::kNeverNs / kNsPerSecond / 4;
  return std::min<std::int64_t>(t.tv_sec, kMostSeconds) * kNsPerSecond + t.tv_nsec;
}

bool IsValid(const timespec& t) {
  return t.tv_sec >= 0 && t.tv_nsec >= 0 && t.tv_nsec < kNsPerSecond;
}

template <class T>
bool Read(const Task& task, std::uint64_t address, T* to) {
  return ReadMemory(task.process->pid, address, to, sizeof *to);
}

template <class T>
bool Write(const Task& task, std::uint64_t address, const T& value) {
  return WriteMemory(task.process->pid, address, &value, sizeof value);
}

bool IsRealtime(std::uint64_t clock) {
  return clock == CLOCK_REALTIME || clock == CLOCK_REALTIME_COARSE || clock == CLOCK_TAI;
}

// A descriptor of a client, for as long as it is looked at.
class Borrowed {
 public:
  Borrowed(const Task& task, int fd) : fd_(DuplicateFd(task.process->pidfd, fd)) {}
  ~Borrowed() {
    if (fd_ >= 0) close(fd_);
  }
  Borrowed(const Borrowed&) = delete;
  Borrowed& operator=(const Borrowed&) = delete;

  // False for files and folders, and for what is no descriptor.
  bool CanWait() const {
    struct stat status;
    if (fd_ < 0 || fstat(fd_, &status) != 0) return false;
    return !S_ISREG(status.st_mode) && !S_ISDIR(status.st_mode) && !S_ISBLK(status.st_mode);
  }
  bool IsNonBlocking() const { return (fcntl(fd_, F_GETFL) & O_NONBLOCK) != 0; }
  bool IsReady(short events) const {
    pollfd probe{fd_, events, 0};
    return poll(&probe, 1, 0) != 0;
  }

 private:
  int fd_;
};

// What goes with a mask, if there is one.
bool IsSoundMask(std::uint64_t mask, std::uint64_t size) { return mask == 0 || size == 8; }

std::optional<std::vector<shm::WaitFd>> PolledFds(const Task& task, const TrappedCall& call) {
  rlimit most{};
  prlimit(task.process->pid, RLIMIT_NOFILE, nullptr, &most);
  if (call.args[1] > most.rlim_cur) return std::nullopt;
  if (call.number == SYS_ppoll && !IsSoundMask(call.args[3], call.args[4])) return std::nullopt;
  std::vector<pollfd> fds(std::min<std::size_t>(call.args[1], kMostPolled));
  if (!fds.empty() &&
      !ReadMemory(task.process->pid, call.args[0], fds.data(), fds.size() * sizeof fds[0])) {
    return std::nullopt;
  }
  std::vector<shm::WaitFd> waited;
  for (const pollfd& fd : fds) {
    if (fd.fd >= 0) waited.push_back({fd.fd, static_cast<unsigned short>(fd.events)});
  }
  return waited;
}

// So many descriptors the kernel looks at: no more than the process's table has room for.
std::size_t SelectedCount(const Task& task, const TrappedCall& call) {
  const auto count = static_cast<std::size_t>(std::max(0, static_cast<int>(call.args[0])));
  return count <= FD_SETSIZE ? count : std::min(count, RoomForDescriptors(task.process->pid));
}

std::size_t WordsOf(std::size_t fds) { return (fds + 63) / 64; }

std::optional<std::vector<shm::WaitFd>> SelectedFds(const Task& task, const TrappedCall& call) {
  if (static_cast<int>(call.args[0]) < 0) return std::nullopt;
  const std::size_t count = SelectedCount(task, call);
  std::vector<std::uint64_t> sets[kSets];
  for (std::size_t i = 0; i < kSets; ++i) {
    sets[i].resize(WordsOf(count));
    if (call.args[i + 1] == 0 || count == 0) continue;
    if (!ReadMemory(task.process->pid, call.args[i + 1], sets[i].data(),
                    sets[i].size() * sizeof sets[i][0])) {
      return std::nullopt;
    }
  }
  constexpr std::uint32_t kEvents[kSets] = {EPOLLIN, EPOLLOUT, EPOLLPRI};
  std::vector<shm::WaitFd> waited;
  for (std::size_t fd = 0; fd < count; ++fd) {
    std::uint32_t events = 0;
    for (std::size_t i = 0; i < kSets; ++i) {
      if ((sets[i][fd / 64] >> (fd % 64) & 1) != 0) events |= kEvents[i];
    }
    if (events != 0) waited.push_back({static_cast<int>(fd), events});
  }
  return waited;
}

bool IsSoundEpollWait(const Task& task, const TrappedCall& call) {
  constexpr int kMostEvents = INT_MAX / static_cast<int>(sizeof(epoll_event));
  const int most = static_cast<int>(call.args[2]);
  if (most <= 0 || most > kMostEvents || static_cast<std::int64_t>(call.args[1]) < 0) return false;
  if (call.number != SYS_epoll_wait && !IsSoundMask(call.args[4], call.args[5])) return false;
  return IsEpollSet(task.process->pid, static_cast<int>(call.args[0]));
}

}  // namespace

std::int64_t Engine::ReadRawClock(const Task& task, const TrappedCall& call) {
  const std::int64_t now = task.reached_ns + task.process->frozen_ns;
  const std::int64_t real = now + header_->realtime_offset_ns;
  if (call.number == SYS_gettimeofday) {
    const timeval t{real / kNsPerSecond, real % kNsPerSecond / 1000};
    return call.args[0] == 0 || Write(task, call.args[0], t) ? 0 : -EFAULT;
  }
  if (call.number == SYS_time) {
    const time_t seconds = real / kNsPerSecond;
    return call.args[0] == 0 || Write(task, call.args[0], seconds) ? seconds : -EFAULT;
  }
  const std::int64_t shown = IsRealtime(call.args[0]) ? real : now + header_->monotonic_offset_ns;
  const timespec t{shown / kNsPerSecond, shown % kNsPerSecond};
  return Write(task, call.args[1], t) ? 0 : -EFAULT;
}

std::int64_t Engine::SleepRaw(Task& task, const TrappedCall& call) {
  const bool plain = call.number == SYS_nanosleep;
  timespec request{};
  if (!Read(task, call.args[plain ? 0 : 2], &request)) return -EFAULT;
  if (!IsValid(request)) return -EINVAL;
  const bool absolute = !plain && (call.args[1] & kTimerAbsolute) != 0;
  std::int64_t until = task.reached_ns + ToNs(request);
  if (absolute) {
    const std::int64_t offset =
        IsRealtime(call.args[0]) ? header_->realtime_offset_ns : header_->monotonic_offset_ns;
    until = ToNs(request) - offset - task.process->frozen_ns;
  }
  task.trap_wait = TrapWait::kSleep;
  task.deadline_ns = std::max(until, task.reached_ns);
  task.remaining_address = absolute ? 0 : call.args[plain ? 1 : 3];
  SetState(task, TaskState::kWaiting);
  return 0;
}

// Goes on once it is ready, or can find all that was sent until now.
void Engine::TransferRaw(Task& task, const TrappedCall& call) {
  const bool reads = call.number == SYS_read || call.number == SYS_readv;
  const short events = reads ? POLLIN : POLLOUT;
  const auto number = static_cast<int>(call.args[0]);
  task.trap_continues = true;
  const Borrowed fd(task, number);
  if (!fd.CanWait()) return;
  if (fd.IsNonBlocking() || fd.IsReady(events)) {
    HoldRaw(task, reads ? shm::NotificationKind::kRead : shm::NotificationKind::kWrite);
    return;
  }
  const shm::WaitFd waited{number, static_cast<std::uint32_t>(events)};
  task.trap_wait = TrapWait::kFds;
  WatchFds(task, &waited, 1);
}

void Engine::HoldRaw(Task& task, shm::NotificationKind kind) {
  if (IsCallback()) return;
  SetState(task, TaskState::kHolding);
  task.hold = kind;
}

// The timeout of a call that waits for descriptors: false if it is not there, or not valid.
bool Engine::RawTimeout(Task& task, const TrappedCall& call, std::int64_t* ns) {
  const auto in_ms = [](std::uint64_t argument) -> std::int64_t {
    const auto ms = static_cast<int>(argument);
    return ms < 0 ? -1 : std::int64_t{ms} * 1'000'000;
  };
  *ns = -1;
  timespec t{};
  switch (call.number) {
    case SYS_poll:
      *ns = in_ms(call.args[2]);
      return true;
    case SYS_epoll_wait:
    case SYS_epoll_pwait:
      *ns = in_ms(call.args[3]);
      return true;
    case SYS_select: {
      timeval tv{};
      if (call.args[4] == 0) return true;
      if (!Read(task, call.args[4], &tv)) return false;
      t = {tv.tv_sec + tv.tv_usec / 1'000'000, tv.tv_usec % 1'000'000 * 1000};
      break;
    }
    default: {
      const std::uint64_t address = call.args[call.number == SYS_ppoll      ? 2
                                              : call.number == SYS_pselect6 ? 4
                                                                            : 3];
      if (address == 0) return true;
      if (!Read(task, address, &t)) return false;
    }
  }
  if (!IsValid(t)) return false;
  *ns = ToNs(t);
  return true;
}

// What the call waits for; none where something is wrong with it, which the kernel says best.
std::optional<std::vector<shm::WaitFd>> Engine::RawWaitFds(const Task& task,
                                                           const TrappedCall& call) {
  switch (call.number) {
    case SYS_poll:
    case SYS_ppoll:
      return PolledFds(task, call);
    case SYS_select:
    case SYS_pselect6:
      return SelectedFds(task, call);
    default:
      if (!IsSoundEpollWait(task, call)) return std::nullopt;
      return std::vector{shm::WaitFd{static_cast<int>(call.args[0]), EPOLLIN}};
  }
}

std::int64_t Engine::PollRaw(Task& task, const TrappedCall& call) {
  std::int64_t timeout_ns = 0;
  task.trap_continues = true;
  // What is wrong with it the kernel says best.
  if (!RawTimeout(task, call, &timeout_ns)) return 0;
  const auto waited = RawWaitFds(task, call);
  if (!waited.has_value()) return 0;
  const bool ready = std::any_of(waited->begin(), waited->end(), [&](const shm::WaitFd& fd) {
    return Borrowed(task, fd.fd).IsReady(static_cast<short>(fd.events));
  });
  if (timeout_ns == 0 || ready) {
    HoldRaw(task, shm::NotificationKind::kRead);
    return 0;
  }
  task.trap_wait = TrapWait::kFds;
  task.deadline_ns =
      timeout_ns < 0 ? shm::kNeverNs : std::max(task.reached_ns, task.reached_ns + timeout_ns);
  WatchFds(task, waited->data(), waited->size());
  return 0;
}

// A wait for descriptors has timed out: none is ready.
void Engine::ClearRawResult(const Task& task, const TrappedCall& call) {
  if (call.number == SYS_poll || call.number == SYS_ppoll) {
    const short none = 0;
    const std::size_t count = std::min<std::size_t>(call.args[1], kMostPolled);
    for (std::size_t i = 0; i < count; ++i) {
      Write(task, call.args[0] + i * sizeof(pollfd) + offsetof(pollfd, revents), none);
    }
  }
  if (call.number == SYS_select || call.number == SYS_pselect6) {
    const std::vector<std::uint64_t> none(WordsOf(SelectedCount(task, call)));
    for (std::size_t i = 1; i <= kSets; ++i) {
      if (call.args[i] == 0) continue;
      WriteMemory(task.process->pid, call.args[i], none.data(), none.size() * sizeof none[0]);
    }
  }
}

void Engine::AwaitChildRaw(Task& task, const TrappedCall& call) {
  const std::uint64_t options = call.args[call.number == SYS_wait4 ? 2 : 3];
  task.trap_continues = true;
  const bool has_living = std::any_of(processes_.begin(), processes_.end(), [&](const Process& p) {
    return p.parent == task.process->pid && !p.dead;
  });
  if ((options & WNOHANG) != 0 || !has_living) {
    HoldRaw(task, shm::NotificationKind::kRead);
    return;
  }
  pid_t which = 0;  // any
  if (call.number == SYS_wait4) which = std::max(0, static_cast<int>(call.args[0]));
  if (call.number == SYS_waitid && call.args[0] == P_PID) which = static_cast<int>(call.args[1]);
  const bool has_ended = std::any_of(processes_.begin(), processes_.end(), [&](const Process& p) {
    return p.parent == task.process->pid && p.dead && !p.is_client &&
           (which == 0 || p.pid == which) && ThreadState(p.pid) == 'Z';
  });
  if (has_ended) return HoldRaw(task, shm::NotificationKind::kRead);
  task.trap_wait = TrapWait::kChild;
  WaitForChild(task, which);
}

void Engine::HandleRawCall(Task& task, const TrappedCall& call) {
  task.trapped_call = call;
  switch (call.number) {
    case SYS_clock_gettime:
    case SYS_gettimeofday:
    case SYS_time:
      task.trap_result = ReadRawClock(task, call);
      break;
    case SYS_nanosleep:
    case SYS_clock_nanosleep:
      task.trap_result = SleepRaw(task, call);
      break;
    case SYS_read:
    case SYS_readv:
    case SYS_write:
    case SYS_writev:
      TransferRaw(task, call);
      break;
    case SYS_poll:
    case SYS_ppoll:
    case SYS_select:
    case SYS_pselect6:
    case SYS_epoll_wait:
    case SYS_epoll_pwait:
    case SYS_epoll_pwait2:
      task.trap_result = PollRaw(task, call);
      break;
    case SYS_wait4:
    case SYS_waitid:
      AwaitChildRaw(task, call);
      break;
    case SYS_sched_yield:
      task.process->robot->ready.Rotate(task.order);
      break;
    case SYS_exit:
      ExitThread(task, call);
      break;
    case SYS_sched_setscheduler:
    case SYS_sched_setparam:
    case SYS_sched_setattr:
    case SYS_sched_setaffinity:
    case SYS_sched_getaffinity:
    case SYS_sched_getscheduler:
    case SYS_sched_getparam:
    case SYS_sched_getattr:
    case SYS_sched_rr_get_interval:
      task.trap_result = ScheduleRaw(task, call);
      break;
    case SYS_timer_create:
    case SYS_timerfd_create:
    case SYS_setitimer:
    case SYS_alarm:
      Warn(fmt::format("{} makes system call {} without the C library: its timer runs in real time",
                       task.process->name, call.number));
      task.trap_continues = true;
      break;
    default:  // SYS_io_uring_setup, SYS_futex_waitv
      task.trap_result = -ENOSYS;
  }
}

// A trapped call that waited goes on, for `reason`.
void Engine::FinishTrappedWait(Task& task, shm::WakeReason reason) {
  // The kernel's ERESTARTSYS and ERESTARTNOINTR, which it never shows to programs.
  constexpr int kRestart = 512, kRestartAlways = 513;
  const TrapWait wait = task.trap_wait;
  if (reason == shm::WakeReason::kSignal) {
    task.trap_continues = false;
    // As the kernel has it: after a handler it makes the call again if that wants it.
    task.trap_result = task.deadline_ns == shm::kNeverNs ? -kRestart : -EINTR;
    // A lock is never given up for a signal: the C library would take it for acquired.
    if (task.lock_owner != nullptr) task.trap_result = -kRestartAlways;
    if (wait == TrapWait::kSleep && task.remaining_address != 0) {
      const std::int64_t left = std::max<std::int64_t>(0, task.deadline_ns - task.reached_ns);
      Write(task, task.remaining_address, timespec{left / kNsPerSecond, left % kNsPerSecond});
    }
    return;
  }
  const bool timed_out = reason == shm::WakeReason::kDeadline;
  task.trap_result = timed_out && wait == TrapWait::kFutex ? -ETIMEDOUT : 0;
  if (timed_out && wait == TrapWait::kFds) {
    task.trap_continues = false;
    ClearRawResult(task, task.trapped_call);
  }
}

}  // namespace tcs
