#include "coordinator/calls/syscall_timers.h"

#include <errno.h>
#include <signal.h>
#include <sys/syscall.h>
#include <sys/time.h>
#include <sys/timerfd.h>
#include <time.h>
#include <unistd.h>

#include <utility>

#include "coordinator/os/open_files.h"
#include "coordinator/os/timer_descriptor.h"
#include "coordinator/port/proc_files.h"
#include "coordinator/port/traps.h"
#include "coordinator/processes/usage_book.h"
#include "coordinator/tasks/client_values.h"
#include "coordinator/tasks/remote_descriptor.h"
#include "shm/clock_ids.h"

namespace tcs {

namespace {

constexpr std::uint64_t kAbsolute = 1;  // TIMER_ABSTIME, TFD_TIMER_ABSTIME

// The kind of timer that timer_create is asked for. 0, or the call's error.
int PosixKind(const Task& task, clockid_t id, const sigevent& event, shm::TimerKind* kind) {
  const shm::ClockOfId clock = shm::ClockOf(id);
  if (const int error = shm::ErrorOfTimerOn(clock); error != 0) return error;
  kind->is_posix = 1;
  if (clock.kind == shm::ClockKind::kProcessCpu) {
    if (clock.owner != 0 && clock.owner != task.process->own_pid) return EINVAL;
    kind->clock = shm::TimerClock::kProcessCpu;
  } else if (clock.kind == shm::ClockKind::kThreadCpu) {
    kind->clock = shm::TimerClock::kThreadCpu;
    kind->clock_tid =
        clock.owner != 0 ? TimerCalls::ThreadNamed(*task.process, clock.owner) : task.tid;
    if (ProcessOfThread(kind->clock_tid) != task.process->pid) return EINVAL;
  } else {
    kind->clock_tid = clock.kind == shm::ClockKind::kRealtime ? 1 : 0;
  }
  kind->value = reinterpret_cast<std::int64_t>(event.sigev_value.sival_ptr);
  if (event.sigev_notify == SIGEV_NONE) return 0;
  if (event.sigev_signo <= 0 || event.sigev_signo > SIGRTMAX) return EINVAL;
  kind->signal = event.sigev_signo;
  if (event.sigev_notify == SIGEV_THREAD_ID) {
    kind->signal_tid = TimerCalls::ThreadNamed(*task.process, event._sigev_un._tid);
    return ProcessOfThread(kind->signal_tid) == task.process->pid ? 0 : EINVAL;
  }
  const bool known = event.sigev_notify == SIGEV_SIGNAL || event.sigev_notify == SIGEV_THREAD;
  return known ? 0 : EINVAL;
}

}  // namespace

std::int64_t SyscallTimers::Create(Task& task, const TrappedCall& call) {
  Process& process = *task.process;
  sigevent event{};
  event.sigev_signo = SIGALRM;
  const int id = static_cast<int>(process.timers.next_id());
  event.sigev_value.sival_int = id;
  if (call.args[1] != 0 && !Read(task, call.args[1], &event)) return -EFAULT;
  shm::TimerKind kind;
  const auto clock = static_cast<clockid_t>(call.args[0]);
  if (const int error = PosixKind(task, clock, event, &kind); error != 0) return -error;
  if (process.timers.IsFull()) return -EAGAIN;
  if (!Write(task, call.args[2], id)) return -EFAULT;
  process.timers.Create(kind);
  return 0;
}

SyscallTimers::Found SyscallTimers::Find(const Task& task, int number) {
  const RemoteDescriptor fd(task, number);
  if (fd.fd() < 0) return {};
  for (Process& process : run_.table.processes()) {
    if (process.dead) continue;
    for (const auto& [id, timer_fd] : process.timer_fds) {
      if (IsSameFile(timer_fd.get(), fd.fd())) return {&process, id};
    }
  }
  return {};
}

// A timer that was made by the call itself, which the kernel carries out, or that comes from
// elsewhere.
SyscallTimers::Found SyscallTimers::Adopt(const Task& task, int number) {
  Process& process = *task.process;
  UniqueFd fd = TimerCalls::DescriptorOf(process, number);
  if (!fd || process.timers.IsFull()) return {};
  shm::TimerKind kind;
  kind.clock_tid = IsOfRealtime(fd.get()) ? 1 : 0;
  const ProcessTimers::Id id = process.timers.Create(kind);
  process.timer_fds[id] = std::move(fd);
  return {&process, id};
}

std::int64_t SyscallTimers::NowOf(const Task& task, const Process& owner,
                                  const shm::TimerKind& kind) const {
  if (kind.clock == shm::TimerClock::kProcessCpu) return UsageBook::ChargedTo(owner).ns();
  if (kind.clock == shm::TimerClock::kTime) return owner.clock.At(task.reached).ns();
  const Task* known = run_.table.Living(kind.clock_tid);
  return known == nullptr ? 0 : known->charged.ns();
}

// Sets the timer (first_ns 0: disarms it) and returns what it was set to: the time until the next
// expiry, and the interval.
itimerspec SyscallTimers::Exchange(Task& task, const Found& found, bool sets, std::int64_t first_ns,
                                   std::int64_t interval_ns, bool is_date) {
  const std::int64_t now = NowOf(task, *found.owner, *found.owner->timers.KindOf(found.id));
  shm::Notification note{};
  note.kind = sets ? shm::NotificationKind::kTimerSet : shm::NotificationKind::kTimerGet;
  note.args[0] = found.id;
  note.args[1] = first_ns;
  note.args[2] = interval_ns;
  note.args[3] = is_date ? 1 : 0;
  calls_.Handle(*found.owner, task, note);
  const std::int64_t next = std::exchange(task.reply[0], 0);
  return {ToTimespec(std::exchange(task.reply[1], 0)), ToTimespec(shm::TimeLeft(next, now))};
}

std::int64_t SyscallTimers::Set(Task& task, const Found& found, const TrappedCall& call) {
  itimerspec given{};
  if (!Read(task, call.args[2], &given)) return -EFAULT;
  if (!IsValid(given)) return -EINVAL;
  const shm::TimerKind kind = *found.owner->timers.KindOf(found.id);
  const bool is_absolute = (call.args[1] & kAbsolute) != 0;
  const bool is_of_time = kind.clock == shm::TimerClock::kTime;
  const bool is_real = is_of_time && kind.clock_tid != 0;
  const std::int64_t offset = is_of_time ? run_.OffsetOf(is_real) : 0;
  const std::int64_t first =
      shm::FirstExpiry(ToNs(given.it_value), is_absolute, NowOf(task, *found.owner, kind), offset);
  const itimerspec before =
      Exchange(task, found, true, first, ToNs(given.it_interval), is_absolute && is_real);
  return call.args[3] == 0 || Write(task, call.args[3], before) ? 0 : -EFAULT;
}

std::int64_t SyscallTimers::IntervalTimer(Task& task, const TrappedCall& call) {
  const std::int64_t which =
      call.number == SYS_alarm ? ITIMER_REAL : static_cast<int>(call.args[0]);
  if (which < ITIMER_REAL || which > ITIMER_PROF) return -EINVAL;
  Found found{task.process, which};
  itimerval given{};
  if (call.number == SYS_alarm) given.it_value.tv_sec = static_cast<unsigned>(call.args[0]);
  if (call.number == SYS_setitimer && call.args[1] != 0 && !Read(task, call.args[1], &given)) {
    return -EFAULT;
  }
  if (!IsValid(given)) return -EINVAL;
  const bool sets = call.number != SYS_getitimer;
  const std::int64_t now = NowOf(task, *task.process, *task.process->timers.KindOf(which));
  const std::int64_t first = shm::FirstExpiry(ToNs(given.it_value), false, now, 0);
  const itimerspec before = Exchange(task, found, sets, first, ToNs(given.it_interval));
  const itimerval old{shm::RoundUpToTimeval(ToNs(before.it_interval)),
                      shm::RoundUpToTimeval(ToNs(before.it_value))};
  if (call.number == SYS_alarm) return shm::AlarmSeconds(old.it_value);
  const std::uint64_t address = call.args[sets ? 2 : 1];
  if (address == 0) return sets ? 0 : -EFAULT;
  return Write(task, address, old) ? 0 : -EFAULT;
}

// Calls that name a timer of timer_create.
std::int64_t SyscallTimers::PosixTimer(Task& task, const TrappedCall& call) {
  const Found found{task.process, static_cast<int>(call.args[0])};
  ProcessTimers& timers = task.process->timers;
  const auto kind = timers.KindOf(found.id);
  if (!kind.has_value() || kind->is_posix == 0) return -EINVAL;
  switch (call.number) {
    case SYS_timer_settime:
      return call.args[2] == 0 ? -EINVAL : Set(task, found, call);
    case SYS_timer_gettime:
      return Write(task, call.args[1], Exchange(task, found, false, 0, 0)) ? 0 : -EFAULT;
    case SYS_timer_getoverrun:
      return calls_.OverrunsAt(*task.process, found.id, task.reached);
    default:  // SYS_timer_delete
      TimerCalls::Delete(*task.process, found.id);
      return 0;
  }
}

void SyscallTimers::Call(Task& task, const TrappedCall& call) {
  switch (call.number) {
    case SYS_timer_create:
      task.trap_result = Create(task, call);
      return;
    case SYS_timerfd_create:
      task.trap_continues = true;  // the timer is known once it is set
      return;
    case SYS_setitimer:
    case SYS_getitimer:
    case SYS_alarm:
      task.trap_result = IntervalTimer(task, call);
      return;
    case SYS_timerfd_settime:
    case SYS_timerfd_gettime: {
      const auto number = static_cast<int>(call.args[0]);
      Found found = Find(task, number);
      if (found.owner == nullptr && call.number == SYS_timerfd_settime) {
        found = Adopt(task, number);
      }
      if (found.owner == nullptr) {
        task.trap_continues = true;  // the kernel says best what is wrong
      } else if (call.number == SYS_timerfd_settime) {
        constexpr std::uint64_t kFlags = TFD_TIMER_ABSTIME | TFD_TIMER_CANCEL_ON_SET;
        task.trap_result = (call.args[1] & ~kFlags) != 0 ? -EINVAL : Set(task, found, call);
      } else {
        task.trap_result =
            Write(task, call.args[1], Exchange(task, found, false, 0, 0)) ? 0 : -EFAULT;
      }
      return;
    }
    default:
      task.trap_result = PosixTimer(task, call);
  }
}

}  // namespace tcs
