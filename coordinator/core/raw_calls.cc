// Trapped calls other than futex: made raw, or by the C library from inside, where no interposed
// symbol sees them. What they wait for is waited for here; then the kernel carries them out, and
// does not have to wait.
#include <errno.h>
#include <limits.h>
#include <poll.h>
#include <sched.h>
#include <signal.h>
#include <sys/epoll.h>
#include <sys/resource.h>
#include <sys/select.h>
#include <sys/syscall.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <time.h>

#include <algorithm>
#include <cstring>
#include <optional>
#include <vector>

#include "coordinator/core/borrowed.h"
#include "coordinator/core/client_values.h"
#include "coordinator/core/engine.h"
#include "coordinator/os/host.h"
#include "coordinator/os/open_files.h"
#include "coordinator/os/signal_bits.h"
#include "shm/clock_ids.h"

namespace tcs {

namespace {

constexpr std::size_t kMostPolled = 65'536, kSets = 3;
constexpr int kTimerAbsolute = 1;          // TIMER_ABSTIME
constexpr std::uint64_t kSetOwnerEx = 15;  // F_SETOWN_EX

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

bool IsOfOwner(const TrappedCall& call) {
  return call.number == SYS_fcntl && call.args[1] == kSetOwnerEx;
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
  return IsAnonymous(task.process->pid, static_cast<int>(call.args[0]), kEpollSet);
}

}  // namespace

std::int64_t Engine::ReadRawClock(const Task& task, const TrappedCall& call) {
  const std::int64_t now = OwnNow(task).ns();
  const std::int64_t real = now + header_->realtime_offset_ns;
  if (call.number == SYS_gettimeofday) {
    return call.args[0] == 0 || Write(task, call.args[0], shm::ToTimeval(real)) ? 0 : -EFAULT;
  }
  if (call.number == SYS_time) {
    const time_t seconds = real / shm::kNsPerSecond;
    return call.args[0] == 0 || Write(task, call.args[0], seconds) ? seconds : -EFAULT;
  }
  const shm::ClockOfId clock = shm::ClockOf(static_cast<clockid_t>(call.args[0]));
  if (!clock.IsOfTime()) return -EINVAL;
  const bool is_real = clock.kind == shm::ClockKind::kRealtime;
  const std::int64_t shown = is_real ? real : now + header_->monotonic_offset_ns;
  return Write(task, call.args[1], ToTimespec(shown)) ? 0 : -EFAULT;
}

std::int64_t Engine::SleepRaw(Task& task, const TrappedCall& call) {
  const bool plain = call.number == SYS_nanosleep;
  const clockid_t clock = plain ? CLOCK_MONOTONIC : static_cast<clockid_t>(call.args[0]);
  if (const int error = shm::ErrorOfSleepOn(clock, task.tid); error != 0) return -error;
  timespec request{};
  if (!Read(task, call.args[plain ? 0 : 2], &request)) return -EFAULT;
  if (!IsValid(request)) return -EINVAL;
  const bool absolute = !plain && (call.args[1] & kTimerAbsolute) != 0;
  std::int64_t until = task.reached_ns + ToTimeoutNs(request);
  if (absolute) {
    const bool is_real = shm::ClockOf(clock).kind == shm::ClockKind::kRealtime;
    const std::int64_t offset =
        is_real ? header_->realtime_offset_ns : header_->monotonic_offset_ns;
    until = task.process->clock.RobotTimeOf(OwnTime(ToTimeoutNs(request) - offset)).ns();
  }
  const std::uint64_t remaining_address = absolute ? 0 : call.args[plain ? 1 : 3];
  EnterWait(task, {awaited::Time{.remaining_address = remaining_address},
                   std::max(until, task.reached_ns), true});
  return 0;
}

// As the shim does it for those that it sees; and those that the C library makes for it inside come
// here, too.
void Engine::SignalRaw(Task& task) {
  task.trap_continues = true;
  if (Slot(task).signals.load() != 0) return;
  task.follow_up = FollowUp::kSignals;
  HoldRaw(task, shm::NotificationKind::kWrite);
}

void Engine::HoldRaw(Task& task, shm::NotificationKind kind) {
  if (IsCallback()) return;
  waker_.Hold(task, kind);
}

// The kernel keeps the order of those who wait for a lock.
void Engine::LockRaw(Task& task) {
  task.trap_continues = true;
  task.expects_kernel = true;
  task.follow_up = FollowUp::kKernelWaits;
  HoldRaw(task, shm::NotificationKind::kWrite);
}

// The timeout of a call that waits for descriptors: false if it is not there, or not valid.
bool Engine::RawTimeout(Task& task, const TrappedCall& call, std::int64_t* ns) {
  const auto in_ms = [](std::uint64_t argument) {
    return shm::MillisecondsToNs(static_cast<int>(argument));
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
  *ns = ToTimeoutNs(t);
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

// The signals that end the call though the thread blocks them: its mask lets them in. Those that do
// nothing, or only stop the thread, do not.
std::uint64_t Engine::RawAwaitedSignals(const Task& task, const TrappedCall& call) {
  constexpr std::uint64_t kNoEnd = SignalBit(SIGCHLD) | SignalBit(SIGCONT) | SignalBit(SIGURG) |
                                   SignalBit(SIGWINCH) | SignalBit(SIGTSTP) | SignalBit(SIGTTIN) |
                                   SignalBit(SIGTTOU);
  constexpr std::uint64_t kNeverHeld = SignalBit(SIGKILL) | SignalBit(SIGSTOP);
  std::uint64_t address = 0, mask = 0;
  switch (call.number) {
    case SYS_ppoll:
      address = call.args[3];
      break;
    case SYS_pselect6:
      if (call.args[5] != 0 && !Read(task, call.args[5], &address)) return 0;
      break;
    case SYS_epoll_pwait:
    case SYS_epoll_pwait2:
      address = call.args[4];
      break;
    default:
      break;
  }
  if (address == 0 || !Read(task, address, &mask)) return 0;
  const SignalSets sets = ReadSignalSets(task.tid);
  return ~mask & ~kNeverHeld & ~sets.ignored & ~(kNoEnd & ~sets.caught);
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
  const std::int64_t deadline_ns =
      timeout_ns < 0 ? shm::kNeverNs : std::max(task.reached_ns, task.reached_ns + timeout_ns);
  awaited::Descriptors watched = descriptors_.Watch(task, waited->data(), waited->size());
  watched.signals = RawAwaitedSignals(task, call);
  EnterWait(task, {std::move(watched), deadline_ns, true});
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

// The kernel is about to tell it of its children's stops.
void Engine::ForgetNews(const Process& parent) {
  for (Process& child : table_.processes()) {
    if (child.parent == parent.pid) child.stop_is_news = child.continue_is_news = false;
  }
}

void Engine::AwaitChildRaw(Task& task, const TrappedCall& call) {
  const std::uint64_t options = call.args[call.number == SYS_wait4 ? 2 : 3];
  task.trap_continues = true;
  const bool stops = (options & (WUNTRACED | WCONTINUED)) != 0;
  unknown_children_.LookFor(*task.process);
  const bool has_living =
      unknown_children_.AreOf(*task.process) ||
      std::any_of(table_.processes().begin(), table_.processes().end(),
                  [&](const Process& p) { return p.parent == task.process->pid && !p.dead; });
  if ((options & WNOHANG) != 0 || !has_living) {
    HoldRaw(task, shm::NotificationKind::kRead);
    return;
  }
  pid_t which = 0;  // any
  if (call.number == SYS_wait4) which = std::max(0, static_cast<int>(call.args[0]));
  if (call.number == SYS_waitid && call.args[0] == P_PID) which = static_cast<int>(call.args[1]);
  const bool has_news =
      std::any_of(table_.processes().begin(), table_.processes().end(), [&](const Process& p) {
        if (p.parent != task.process->pid || p.is_client || (which != 0 && p.pid != which))
          return false;
        if (p.dead) return ThreadState(p.pid) == 'Z';
        return ((options & WUNTRACED) != 0 && p.stop_is_news) ||
               ((options & WCONTINUED) != 0 && p.continue_is_news);
      });
  if (stops) ForgetNews(*task.process);
  if (has_news) return HoldRaw(task, shm::NotificationKind::kRead);
  EnterWait(task, {awaited::Child{which, stops}, shm::kNeverNs, true});
}

// True: as Handle.
bool Engine::HandleRawCall(Task& task, const TrappedCall& call) {
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
    case SYS_recvfrom:
    case SYS_recvmsg:
    case SYS_recvmmsg:
    case SYS_sendto:
    case SYS_sendmsg:
    case SYS_sendmmsg:
    case SYS_accept:
    case SYS_accept4:
    case SYS_connect:
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
    case SYS_kill:
    case SYS_tkill:
    case SYS_tgkill:
    case SYS_rt_sigqueueinfo:
    case SYS_rt_tgsigqueueinfo:
    case SYS_pidfd_send_signal:
      SignalRaw(task);
      break;
    case SYS_sched_yield:
      return Yield(task);
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
      task.trap_result = raw_scheduling_.Call(task, call);
      break;
    case SYS_timer_create:
    case SYS_timer_settime:
    case SYS_timer_gettime:
    case SYS_timer_getoverrun:
    case SYS_timer_delete:
    case SYS_timerfd_create:
    case SYS_timerfd_settime:
    case SYS_timerfd_gettime:
    case SYS_setitimer:
    case SYS_getitimer:
    case SYS_alarm:
      raw_timers_.Call(task, call);
      return true;  // it may have written to its descriptor
    case SYS_flock:
    case SYS_fcntl:
      if (IsOfOwner(call)) {
        task.trap_continues = true;
      } else {
        LockRaw(task);
      }
      break;
    case SYS_ioctl:
    case SYS_ptrace:
    case SYS_pidfd_getfd:
    case SYS_process_madvise:
      task.trap_continues = true;  // unless it is about tcsim's own (guarded_calls.cc)
      break;
    case SYS_futex_waitv:
      task.trap_result = words_.WaitForAny(task, call);
      break;
    default:  // SYS_io_uring_setup
      task.trap_result = -ENOSYS;
  }
  return task.Awaits<awaited::Descriptors>() != nullptr;
}

// A signal's handler ends a trapped call that waits; the result may be the kernel's ERESTARTSYS or
// ERESTARTNOINTR, which it never shows to programs: then it makes the call again.
void Engine::InterruptTrappedWait(Task& task) {
  constexpr int kRestart = 512, kRestartAlways = 513;
  const Wait& wait = *task.wait;
  task.trap_continues = false;
  task.trap_result = wait.deadline_ns == shm::kNeverNs ? -kRestart : -EINTR;
  if (const auto* futex = wait.As<awaited::Futex>(); futex != nullptr) {
    // A lock is never given up for a signal: the C library would take it for acquired.
    if (futex->owner != awaited::kNobody || words_.table().ExpectedLock(task.order).has_value()) {
      task.trap_result = -kRestartAlways;
    }
    if (futex->was_requeued) task.trap_result = -EAGAIN;
    if (words_.table().WaitsForAny(task.order)) task.trap_result = -kRestart;
  }
  const auto* sleep = wait.As<awaited::Time>();
  if (sleep != nullptr && sleep->remaining_address != 0) {
    const std::int64_t left = std::max<std::int64_t>(0, wait.deadline_ns - task.reached_ns);
    Write(task, sleep->remaining_address, ToTimespec(left));
  }
}

// A trapped call that waited goes on, for `reason`.
void Engine::FinishTrappedWait(Task& task, shm::WakeReason reason) {
  if (reason == shm::WakeReason::kSignal) return InterruptTrappedWait(task);
  const bool timed_out = reason == shm::WakeReason::kDeadline;
  task.trap_result = 0;
  if (const auto* futex = task.Awaits<awaited::Futex>(); futex != nullptr) {
    task.trap_result = timed_out ? -ETIMEDOUT : static_cast<std::int64_t>(futex->woken_word);
  }
  if (const auto* child = task.Awaits<awaited::Child>(); child != nullptr && child->stops) {
    ForgetNews(*task.process);
  }
  const auto* watched = task.Awaits<awaited::Descriptors>();
  if (watched == nullptr) return;
  if (!timed_out) {
    if (watched->transfers && Receives(task.trapped_call)) activations_.ReceivedRaw(task, false);
    return;
  }
  task.trap_continues = false;
  if (watched->transfers) {
    task.trap_result = -EAGAIN;
  } else {
    ClearRawResult(task, task.trapped_call);
  }
}

}  // namespace tcs
