#include "coordinator/calls/syscalls.h"

#include <errno.h>
#include <sys/syscall.h>

#include "coordinator/calls/sent_signal.h"
#include "coordinator/calls/signal_reach.h"
#include "coordinator/calls/syscall_draws.h"
#include "coordinator/os/landlock.h"
#include "shm/clock_ids.h"

namespace tcs {

namespace {

constexpr std::uint64_t kSetOwnerEx = 15;  // F_SETOWN_EX

bool IsOfOwner(const TrappedCall& call) {
  return call.number == SYS_fcntl && call.args[1] == kSetOwnerEx;
}

}  // namespace

// Does what the shim does for the calls that it sees; the calls that the C library makes for the
// shim inside come here, too.
void Syscalls::Signal(Task& task) {
  task.trap_continues = true;
  if (OnlyAsks(task.trapped_call)) return;
  // The shim waits for this one call; any other call is a handler's, which interrupts the shim.
  if (SlotOf(task).signals.load() == shm::kSendsByLibrary && task.sending.number == 0) {
    task.sending = task.trapped_call;
    return;
  }
  task.after_call = AfterCall::kSignals;
  ReachBySignal(run_, task, 0);
  waker_.HoldInCall(task, shm::NotificationKind::kWrite);
}

// The kernel puts the mask in place, and ends the wait once a handler has run: at the virtual time
// at which the signal was sent, as it does for all threads that wait.
void Syscalls::Suspend(Task& task) {
  task.trap_continues = true;
  task.expects_kernel = true;
}

// The kernel keeps the order of the threads that wait for a lock.
void Syscalls::Lock(Task& task) {
  task.trap_continues = true;
  task.expects_kernel = true;
  task.after_call = AfterCall::kKernelWaits;
  waker_.HoldInCall(task, shm::NotificationKind::kWrite);
}

bool Syscalls::Handle(Task& task, const TrappedCall& call) {
  task.trapped_call = call;
  switch (call.number) {
    case SYS_clock_gettime:
      task.trap_result = shm::ClockOf(static_cast<clockid_t>(call.args[0])).IsOfCpu()
                             ? parts_.usage.ReadClock(task, call)
                             : parts_.times.ReadClock(task, call);
      break;
    case SYS_getrusage:
      task.trap_result = parts_.usage.GetUsage(task, call);
      break;
    case SYS_times:
      task.trap_result = parts_.usage.Times(task, call);
      break;
    case SYS_sysinfo:
      task.trap_result = parts_.usage.SystemInfo(task, call);
      break;
    case SYS_gettimeofday:
    case SYS_time:
      task.trap_result = parts_.times.ReadClock(task, call);
      break;
    case SYS_clock_settime:
    case SYS_settimeofday:
      task.trap_result = parts_.times.SetClock(task, call);
      break;
    case SYS_adjtimex:
    case SYS_clock_adjtime:
      task.trap_result = parts_.times.Adjust(task, call);
      break;
    case SYS_nanosleep:
    case SYS_clock_nanosleep:
      task.trap_result = parts_.times.Sleep(task, call);
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
      parts_.transfers.Handle(task, call);
      break;
    case SYS_poll:
    case SYS_ppoll:
    case SYS_select:
    case SYS_pselect6:
    case SYS_epoll_wait:
    case SYS_epoll_pwait:
    case SYS_epoll_pwait2:
      task.trap_result = parts_.polls.Poll(task, call);
      break;
    case SYS_wait4:
    case SYS_waitid:
      parts_.children.Await(task, call);
      break;
    case SYS_kill:
    case SYS_tkill:
    case SYS_tgkill:
    case SYS_rt_sigqueueinfo:
    case SYS_rt_tgsigqueueinfo:
    case SYS_pidfd_send_signal:
      Signal(task);
      break;
    case SYS_rt_sigsuspend:
    case SYS_pause:
      Suspend(task);
      break;
    case SYS_sched_yield:
      return yield_(task);
    case SYS_exit:
      exit_(task, call);
      break;
    case SYS_clone:
    case SYS_clone3:
    case SYS_fork:
    case SYS_vfork:
      task.trap_continues = true;
      Spawns::Begin(task, call);
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
      task.trap_result = parts_.scheduling.Call(task, call);
      break;
    case SYS_getcpu:
      task.trap_result = SyscallScheduling::CoreOf(task, call);
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
      parts_.timers.Call(task, call);
      return true;  // the timer may have written to its descriptor
    case SYS_getrandom:
      task.trap_result = SyscallDraws::GetRandom(task, call);
      break;
    case SYS_flock:
    case SYS_fcntl:
      if (IsOfOwner(call)) {
        task.trap_continues = true;
      } else {
        Lock(task);
      }
      break;
    case SYS_semop:
    case SYS_semtimedop:
    case SYS_semctl:
    case SYS_msgsnd:
    case SYS_msgrcv:
    case SYS_msgctl:
      parts_.ipc.OfSystemV(task, call);
      break;
    case SYS_mq_timedsend:
    case SYS_mq_timedreceive:
      parts_.ipc.Queue(task, call);
      break;
    case SYS_rt_sigtimedwait:
      parts_.ipc.AcceptSignal(task, call);
      break;
    case SYS_bind:
      task.trap_continues = true;
      parts_.local_sockets.BindsUnseen(task.process->robot, call);
      break;
    case SYS_setrlimit:
    case SYS_getrlimit:
    case SYS_prlimit64:
      task.trap_result = parts_.limits.Call(task, call);
      break;
    case SYS_open:
    case SYS_openat:
      parts_.computer_files.Open(task, call);
      break;
    case SYS_pidfd_getfd:
      task.trap_continues = true;
      parts_.local_sockets.ReachesBy(task, call);
      waker_.HoldInCall(task, shm::NotificationKind::kWrite);
      break;
    case SYS_ioctl:
    case SYS_ptrace:
    case SYS_process_madvise:
      task.trap_continues = true;  // unless it is about tcsim's own processes (guarded_calls.cc)
      break;
    case SYS_landlock_create_ruleset:
      if (AsksForLandlockVersion(call.args)) {
        task.trap_result = LandlockVersionForPrograms();
      } else {
        task.trap_continues = true;
      }
      break;
    case SYS_futex_waitv:
      task.trap_result = parts_.words.WaitForAny(task, call);
      break;
    default:  // SYS_io_uring_setup
      task.process->asked_for_io_uring = true;
      task.trap_result = -ENOSYS;
  }
  return task.Awaits<awaited::Descriptors>() != nullptr;
}

}  // namespace tcs
