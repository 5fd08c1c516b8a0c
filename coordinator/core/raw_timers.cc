// Timers whose calls are made raw: they are the same as those that the shim makes for its program,
// so a timer made one way can be set the other way.
#include <errno.h>
#include <signal.h>
#include <sys/syscall.h>
#include <sys/time.h>
#include <sys/timerfd.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <optional>

#include "coordinator/core/borrowed.h"
#include "coordinator/core/client_values.h"
#include "coordinator/core/engine.h"
#include "coordinator/os/host.h"
#include "coordinator/os/open_files.h"
#include "coordinator/os/timer_descriptor.h"

namespace tcs {

namespace {

constexpr std::uint64_t kAbsolute = 1;  // TIMER_ABSTIME, TFD_TIMER_ABSTIME

timeval RoundUp(std::int64_t ns) {
  const std::int64_t us = (ns + 999) / 1000;
  return {us / 1'000'000, us % 1'000'000};
}

bool IsRealtime(std::int64_t clock) {
  return clock == CLOCK_REALTIME || clock == CLOCK_REALTIME_ALARM || clock == CLOCK_TAI;
}

bool IsMonotonic(std::int64_t clock) {
  return clock == CLOCK_MONOTONIC || clock == CLOCK_BOOTTIME || clock == CLOCK_BOOTTIME_ALARM;
}

// What timer_create is asked for; none if the kernel has no such timer.
std::optional<shm::TimerKind> PosixKind(const Task& task, int clock, const sigevent& event) {
  shm::TimerKind kind;
  kind.is_posix = 1;
  if (clock == CLOCK_PROCESS_CPUTIME_ID) {
    kind.clock = shm::TimerClock::kProcessCpu;
  } else if (clock == CLOCK_THREAD_CPUTIME_ID) {
    kind.clock = shm::TimerClock::kThreadCpu;
    kind.clock_tid = task.tid;
  } else if (IsRealtime(clock)) {
    kind.clock_tid = 1;
  } else if (!IsMonotonic(clock)) {
    return std::nullopt;
  }
  kind.value = reinterpret_cast<std::int64_t>(event.sigev_value.sival_ptr);
  if (event.sigev_notify == SIGEV_NONE) return kind;
  if (event.sigev_signo <= 0 || event.sigev_signo > SIGRTMAX) return std::nullopt;
  kind.signal = event.sigev_signo;
  if (event.sigev_notify == SIGEV_THREAD_ID) {
    kind.signal_tid = event._sigev_un._tid;
    return ProcessOfThread(kind.signal_tid) == task.process->pid ? std::optional(kind)
                                                                 : std::nullopt;
  }
  const bool known = event.sigev_notify == SIGEV_SIGNAL || event.sigev_notify == SIGEV_THREAD;
  return known ? std::optional(kind) : std::nullopt;
}

}  // namespace

std::int64_t Engine::CreateTimerRaw(Task& task, const TrappedCall& call) {
  Process& process = *task.process;
  sigevent event{};
  event.sigev_signo = SIGALRM;
  const int id = static_cast<int>(process.timers.next_id());
  event.sigev_value.sival_int = id;
  if (call.args[1] != 0 && !Read(task, call.args[1], &event)) return -EFAULT;
  const auto kind = PosixKind(task, static_cast<int>(call.args[0]), event);
  if (!kind.has_value()) return -EINVAL;
  if (process.timers.IsFull()) return -EAGAIN;
  if (!Write(task, call.args[2], id)) return -EFAULT;
  process.timers.Create(*kind);
  return 0;
}

// Whose descriptor it is, too: timers made before a fork are the parent's.
Engine::FoundTimer Engine::FindTimerFd(const Task& task, int number) {
  const Borrowed fd(task, number);
  if (fd.fd() < 0) return {};
  for (Process& process : processes_) {
    if (process.dead) continue;
    for (const auto& [id, timer_fd] : process.timer_fds) {
      if (IsSameFile(timer_fd.get(), fd.fd())) return {&process, id};
    }
  }
  return {};
}

// One that was made by the call itself, which the kernel carries out, or that comes from elsewhere.
Engine::FoundTimer Engine::AdoptTimerFd(const Task& task, int number) {
  Process& process = *task.process;
  UniqueFd fd = TimerDescriptorOf(process, number);
  if (!fd || process.timers.IsFull()) return {};
  shm::TimerKind kind;
  kind.clock_tid = IsOfRealtime(fd.get()) ? 1 : 0;
  const ProcessTimers::Id id = process.timers.Create(kind);
  process.timer_fds[id] = std::move(fd);
  return {&process, id};
}

std::int64_t Engine::TimerNow(const Task& task, const Process& owner,
                              const shm::TimerKind& kind) const {
  if (kind.clock == shm::TimerClock::kProcessCpu) return ChargedTo(owner);
  if (kind.clock == shm::TimerClock::kTime) return task.reached_ns + owner.frozen_ns;
  const auto known = by_tid_.find(kind.clock_tid);
  return known == by_tid_.end() ? 0 : known->second->charged_ns;
}

// Sets it (first_ns 0: disarms it) and returns what it was set to: until the next expiry, and the
// interval.
itimerspec Engine::ExchangeTimer(Task& task, const FoundTimer& found, bool sets,
                                 std::int64_t first_ns, std::int64_t interval_ns) {
  const std::int64_t now = TimerNow(task, *found.owner, *found.owner->timers.KindOf(found.id));
  shm::Notification note{};
  note.kind = sets ? shm::NotificationKind::kTimerSet : shm::NotificationKind::kTimerGet;
  note.args[0] = found.id;
  note.args[1] = first_ns;
  note.args[2] = interval_ns;
  SetTimerOf(*found.owner, task, note);
  const std::int64_t next = std::exchange(task.reply[0], 0);
  const std::int64_t left = next == 0 ? 0 : std::max<std::int64_t>(1, next - now);
  return {ToTimespec(std::exchange(task.reply[1], 0)), ToTimespec(left)};
}

std::int64_t Engine::SetTimerRaw(Task& task, const FoundTimer& found, const TrappedCall& call) {
  itimerspec given{};
  if (!Read(task, call.args[2], &given)) return -EFAULT;
  if (!IsValid(given.it_value) || !IsValid(given.it_interval)) return -EINVAL;
  const shm::TimerKind kind = *found.owner->timers.KindOf(found.id);
  std::int64_t first = ToNs(given.it_value);
  if (first != 0) {
    std::int64_t offset = -TimerNow(task, *found.owner, kind);
    if ((call.args[1] & kAbsolute) != 0) {
      offset = kind.clock != shm::TimerClock::kTime ? 0
               : kind.clock_tid != 0                ? header_->realtime_offset_ns
                                                    : header_->monotonic_offset_ns;
    }
    first = std::max<std::int64_t>(1, first - offset);  // long past, but armed
  }
  const itimerspec before = ExchangeTimer(task, found, true, first, ToNs(given.it_interval));
  return call.args[3] == 0 || Write(task, call.args[3], before) ? 0 : -EFAULT;
}

std::int64_t Engine::ItimerRaw(Task& task, const TrappedCall& call) {
  const std::int64_t which =
      call.number == SYS_alarm ? ITIMER_REAL : static_cast<int>(call.args[0]);
  if (which < ITIMER_REAL || which > ITIMER_PROF) return -EINVAL;
  FoundTimer found{task.process, which};
  itimerval given{};
  if (call.number == SYS_alarm) given.it_value.tv_sec = static_cast<unsigned>(call.args[0]);
  if (call.number == SYS_setitimer && call.args[1] != 0 && !Read(task, call.args[1], &given)) {
    return -EFAULT;
  }
  const timespec value{given.it_value.tv_sec, given.it_value.tv_usec * 1000},
      interval{given.it_interval.tv_sec, given.it_interval.tv_usec * 1000};
  if (!IsValid(value) || !IsValid(interval)) return -EINVAL;
  const bool sets = call.number != SYS_getitimer;
  const std::int64_t delay = ToNs(value);
  const std::int64_t first =
      delay == 0 ? 0 : TimerNow(task, *task.process, *task.process->timers.KindOf(which)) + delay;
  const itimerspec before = ExchangeTimer(task, found, sets, first, ToNs(interval));
  const itimerval old{RoundUp(ToNs(before.it_interval)), RoundUp(ToNs(before.it_value))};
  if (call.number == SYS_alarm) {
    // As the kernel rounds it: never 0 while it was armed.
    const bool up =
        old.it_value.tv_usec >= 500'000 || (old.it_value.tv_sec == 0 && old.it_value.tv_usec > 0);
    return old.it_value.tv_sec + (up ? 1 : 0);
  }
  const std::uint64_t address = call.args[sets ? 2 : 1];
  if (address == 0) return sets ? 0 : -EFAULT;
  return Write(task, address, old) ? 0 : -EFAULT;
}

// Calls that name a timer of timer_create.
std::int64_t Engine::PosixTimerRaw(Task& task, const TrappedCall& call) {
  const FoundTimer found{task.process, static_cast<int>(call.args[0])};
  ProcessTimers& timers = task.process->timers;
  const auto kind = timers.KindOf(found.id);
  if (!kind.has_value() || kind->is_posix == 0) return -EINVAL;
  switch (call.number) {
    case SYS_timer_settime:
      return SetTimerRaw(task, found, call);
    case SYS_timer_gettime:
      return Write(task, call.args[1], ExchangeTimer(task, found, false, 0, 0)) ? 0 : -EFAULT;
    case SYS_timer_getoverrun:
      NoteAccepted(*task.process);
      return timers.Overruns(found.id);
    default:  // SYS_timer_delete
      DeleteTimer(*task.process, found.id);
      return 0;
  }
}

void Engine::HandleRawTimer(Task& task, const TrappedCall& call) {
  switch (call.number) {
    case SYS_timer_create:
      task.trap_result = CreateTimerRaw(task, call);
      return;
    case SYS_timerfd_create:
      task.trap_continues = true;  // it is known once it is set
      return;
    case SYS_setitimer:
    case SYS_getitimer:
    case SYS_alarm:
      task.trap_result = ItimerRaw(task, call);
      return;
    case SYS_timerfd_settime:
    case SYS_timerfd_gettime: {
      const auto number = static_cast<int>(call.args[0]);
      FoundTimer found = FindTimerFd(task, number);
      if (found.owner == nullptr && call.number == SYS_timerfd_settime) {
        found = AdoptTimerFd(task, number);
      }
      if (found.owner == nullptr) {
        task.trap_continues = true;  // what is wrong with it the kernel says best
      } else if (call.number == SYS_timerfd_settime) {
        constexpr std::uint64_t kFlags = TFD_TIMER_ABSTIME | TFD_TIMER_CANCEL_ON_SET;
        task.trap_result = (call.args[1] & ~kFlags) != 0 ? -EINVAL : SetTimerRaw(task, found, call);
      } else {
        task.trap_result =
            Write(task, call.args[1], ExchangeTimer(task, found, false, 0, 0)) ? 0 : -EFAULT;
      }
      return;
    }
    default:
      task.trap_result = PosixTimerRaw(task, call);
  }
}

}  // namespace tcs
