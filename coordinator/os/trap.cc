#include "coordinator/os/trap.h"

#include <asm/prctl.h>
#include <errno.h>
#include <fcntl.h>
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/futex.h>
#include <linux/seccomp.h>
#include <sched.h>
#include <stddef.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <iterator>
#include <vector>

#include "coordinator/os/filter_code.h"
#include "coordinator/os/protection.h"
#include "shm/layout.h"

namespace tcs {

namespace {

using filter::Load;
using filter::LoadArgument;
using filter::Return;

// The trapped calls besides futex, which depends on its arguments, and those whose mark is
// elsewhere.
constexpr std::uint32_t kTrapped[] = {
    // Clocks and sleeps.
    SYS_clock_gettime, SYS_gettimeofday, SYS_time, SYS_nanosleep, SYS_clock_nanosleep,
    // Settings of the host's clock.
    SYS_clock_settime, SYS_settimeofday, SYS_adjtimex, SYS_clock_adjtime,
    // The charged time, and the time since the computer is on.
    SYS_getrusage, SYS_times, SYS_sysinfo,
    // Waits for descriptors and for children.
    SYS_read, SYS_readv, SYS_write, SYS_writev, SYS_poll, SYS_ppoll, SYS_select, SYS_pselect6,
    SYS_epoll_wait, SYS_epoll_pwait, SYS_epoll_pwait2, SYS_wait4, SYS_waitid, SYS_recvmsg,
    SYS_recvmmsg, SYS_sendmsg, SYS_sendmmsg, SYS_accept, SYS_accept4, SYS_connect, SYS_bind,
    // Signals to others.
    SYS_kill, SYS_tkill, SYS_tgkill, SYS_rt_sigqueueinfo, SYS_rt_tgsigqueueinfo,
    SYS_pidfd_send_signal,
    // Waits for handlers.
    SYS_rt_sigsuspend, SYS_pause,
    // The scheduler: the host's must not hear of it.
    SYS_sched_yield, SYS_sched_setscheduler, SYS_sched_setparam, SYS_sched_setattr,
    SYS_sched_setaffinity, SYS_sched_getaffinity, SYS_sched_getscheduler, SYS_sched_getparam,
    SYS_sched_getattr, SYS_sched_rr_get_interval, SYS_getcpu,
    // The end of a thread, and the beginnings of threads and processes (clone_call.h).
    SYS_exit, SYS_clone, SYS_clone3, SYS_fork, SYS_vfork,
    // Refused, so that programs take the calls that are known here.
    SYS_io_uring_setup,
    // Sandboxes that would keep new threads from the coordinator (landlock.h).
    SYS_landlock_create_ruleset,
    // Timers.
    SYS_timer_create, SYS_timer_settime, SYS_timer_gettime, SYS_timer_getoverrun, SYS_timer_delete,
    SYS_timerfd_create, SYS_timerfd_settime, SYS_timerfd_gettime, SYS_setitimer, SYS_getitimer,
    SYS_alarm,
    // Locks of files.
    SYS_flock,
    // Semaphores, queues, and signals that are accepted.
    SYS_semop, SYS_semtimedop, SYS_semctl, SYS_msgsnd, SYS_msgrcv, SYS_msgctl, SYS_mq_timedsend,
    SYS_mq_timedreceive, SYS_rt_sigtimedwait,
    // Several futexes at once.
    SYS_futex_waitv};

// The trapped calls that the shim makes most often, for programs and for itself. Their marks are
// looked for before the long list of others is gone through, which took 40 ns.
constexpr std::uint32_t kFrequent[] = {SYS_write,      SYS_read,    SYS_ppoll,
                                       SYS_epoll_wait, SYS_sendmsg, SYS_recvmsg};

constexpr std::uint32_t kSignals[] = {SYS_kill,
                                      SYS_tkill,
                                      SYS_tgkill,
                                      SYS_rt_sigqueueinfo,
                                      SYS_rt_tgsigqueueinfo,
                                      SYS_pidfd_send_signal};

// These calls are trapped also if the shim makes them.
constexpr std::uint32_t kExecutions[] = {SYS_execve, SYS_execveat};
constexpr std::uint32_t kEnd = SYS_exit_group;

// As a jump over the given number of instructions where the value just loaded is, or is not, `k`.
sock_filter JumpIfEqual(std::uint32_t k, std::size_t yes, std::size_t no) {
  return {BPF_JMP | BPF_JEQ | BPF_K, static_cast<std::uint8_t>(yes), static_cast<std::uint8_t>(no),
          k};
}

// libnuma compares the processors that it is told of, which are the robot's, with the nodes of the
// host's memory in /sys, which it looks at only if the kernel knows this call.
constexpr std::uint32_t kNuma = SYS_get_mempolicy;

// With this call a program reads the host's processor from its own memory, where the kernel writes
// it. Without the call the C library takes the next way, getcpu, and so do others.
constexpr std::uint32_t kRseq = SYS_rseq;

// Flags of opens that are not for reading only.
constexpr std::uint32_t kMakesOrWrites = O_ACCMODE | O_CREAT | O_PATH;

// The upper half of an argument.
sock_filter LoadUpper(std::size_t argument) {
  return Load(offsetof(seccomp_data, args) + sizeof(std::uint64_t) * argument +
              sizeof(std::uint32_t));
}

// Calls that are trapped by their numbers alone.
struct TrappedNumbers {
  std::vector<std::uint32_t> others;    // unless the shim made the call
  std::vector<std::uint32_t> unmarked;  // also if the shim made the call
};

// Allows a frequent call that the shim makes. Before and after it the number is loaded.
std::vector<sock_filter> AllowFrequent() {
  const std::size_t count = std::size(kFrequent);
  std::vector<sock_filter> program;
  for (std::size_t i = 0; i < count; ++i) {
    program.push_back(JumpIfEqual(kFrequent[i], count - i, 0));
  }
  program.push_back({BPF_JMP | BPF_JA, 0, 0, 4});
  program.push_back(LoadArgument(5));
  program.push_back(JumpIfEqual(shm::kOwnCallMark, 0, 1));
  program.push_back(Return(SECCOMP_RET_ALLOW));
  program.push_back(Load(offsetof(seccomp_data, nr)));
  return program;
}

// The filter for the calls of this architecture's programs, after the number was loaded.
std::vector<sock_filter> NativeProgram(const TrappedNumbers& numbers) {
  const sock_filter allow = Return(SECCOMP_RET_ALLOW), trap = Return(SECCOMP_RET_USER_NOTIF);
  std::vector<std::uint32_t> trapped = numbers.others;
  trapped.insert(trapped.end(), numbers.unmarked.begin(), numbers.unmarked.end());
  const std::size_t count = trapped.size();
  std::vector<sock_filter> program{
      JumpIfEqual(kNuma, 1, 0),
      JumpIfEqual(kRseq, 0, 1),
      Return(SECCOMP_RET_ERRNO | ENOSYS),
      // A call of the first thread only: other threads are made with their storage.
      JumpIfEqual(SYS_arch_prctl, 0, 4),
      LoadArgument(0),
      JumpIfEqual(ARCH_SET_FS, 0, 1),
      trap,
      allow,
      JumpIfEqual(SYS_futex, 0, 6),
      LoadArgument(1),
      // The shim waits at its gate with this operation, which has no use for its last argument.
      JumpIfEqual(FUTEX_WAIT, 0, 3),
      LoadArgument(5),
      JumpIfEqual(shm::kOwnCallMark, 0, 1),
      allow,
      trap,
      // Locks only.
      JumpIfEqual(SYS_fcntl, 0, 10),
      LoadArgument(1),
      JumpIfEqual(F_SETLK, 4, 0),
      JumpIfEqual(F_SETLKW, 3, 0),
      JumpIfEqual(F_OFD_SETLK, 2, 0),
      JumpIfEqual(F_OFD_SETLKW, 1, 0),
      allow,
      LoadArgument(5),
      JumpIfEqual(shm::kOwnCallMark, 0, 1),
      allow,
      trap,
      // Limits of processor time only: the charged time is to be limited.
      JumpIfEqual(SYS_prlimit64, 0, 2),
      LoadArgument(1),
      {BPF_JMP | BPF_JA, 0, 0, 3},
      JumpIfEqual(SYS_setrlimit, 1, 0),
      JumpIfEqual(SYS_getrlimit, 0, 4),
      LoadArgument(0),
      JumpIfEqual(RLIMIT_CPU, 0, 1),
      trap,
      allow,
      // Files that are opened for reading only: the file may be one of the robot's computer.
      JumpIfEqual(SYS_open, 0, 2),
      LoadArgument(1),
      {BPF_JMP | BPF_JA, 0, 0, 2},
      JumpIfEqual(SYS_openat, 0, 6),
      LoadArgument(2),
      {BPF_JMP | BPF_JSET | BPF_K, 2, 0, kMakesOrWrites},
      LoadArgument(5),
      JumpIfEqual(shm::kOwnCallMark, 0, 1),
      allow,
      trap,
      // These calls have their mark beside the flags.
      JumpIfEqual(SYS_recvfrom, 1, 0),
      JumpIfEqual(SYS_sendto, 0, 4),
      LoadUpper(3),
      JumpIfEqual(shm::kOwnCallMark, 0, 1),
      allow,
      trap,
  };
  for (std::size_t i = 0; i < count; ++i) {
    const bool is_marked = i < numbers.others.size();
    program.push_back(JumpIfEqual(trapped[i], count - i + (is_marked ? 0 : 3), 0));
  }
  program.push_back(allow);
  program.push_back(LoadArgument(5));
  program.push_back(JumpIfEqual(shm::kOwnCallMark, 0, 1));
  program.push_back(allow);
  program.push_back(trap);
  return program;
}

std::vector<sock_filter> Program(const std::vector<pid_t>& guarded, const TrappedNumbers& numbers) {
  constexpr std::uint32_t kX32 = 0x40000000;  // a third table of numbers, which nobody uses
  const std::vector<sock_filter> of_32_bits = Protection(CallTable::kOf32Bits, guarded);
  std::vector<sock_filter> program{
      Load(offsetof(seccomp_data, arch)),
      JumpIfEqual(AUDIT_ARCH_X86_64, 0, 1),
      {BPF_JMP | BPF_JA, 0, 0, static_cast<std::uint32_t>(of_32_bits.size() + 2)},
      Load(offsetof(seccomp_data, nr)),
  };
  const auto append = [&program](const std::vector<sock_filter>& more) {
    program.insert(program.end(), more.begin(), more.end());
  };
  append(of_32_bits);
  program.push_back(Return(SECCOMP_RET_ALLOW));
  program.push_back(Load(offsetof(seccomp_data, nr)));
  program.push_back({BPF_JMP | BPF_JGE | BPF_K, 0, 1, kX32});
  program.push_back(Return(SECCOMP_RET_ERRNO | ENOSYS));
  append(AllowFrequent());
  append(Protection(CallTable::kNative, guarded));
  append(NativeProgram(numbers));
  return program;
}

constexpr unsigned kHoldsSignals = 1u << 5;  // SECCOMP_FILTER_FLAG_WAIT_KILLABLE_RECV, Linux 5.19

}  // namespace

bool TrapsHoldSignals() {
  // The kernel looks at the flags before the filter, which is nowhere.
  return syscall(SYS_seccomp, SECCOMP_SET_MODE_FILTER,
                 SECCOMP_FILTER_FLAG_NEW_LISTENER | kHoldsSignals, nullptr) != 0 &&
         errno == EFAULT;
}

int InstallTrap(const std::vector<pid_t>& guarded, TrappedToo too) {
  // Without a real-time priority nothing but the kernel, if it can, keeps a thread in its call when
  // a signal comes; and the thread may be sent a signal to stop it.
  const bool has_level = sched_getscheduler(0) == SCHED_FIFO;
  TrappedNumbers numbers{{std::begin(kTrapped), std::end(kTrapped)}, {}};
  if (too.draws) numbers.others.push_back(SYS_getrandom);
  if (!has_level || too.executions) {
    numbers.unmarked.assign(std::begin(kExecutions), std::end(kExecutions));
  }
  numbers.unmarked.push_back(kEnd);
  std::vector<sock_filter> program = Program(guarded, numbers);
  const sock_fprog filter{static_cast<unsigned short>(program.size()), program.data()};
  auto install = [&filter](unsigned more) {
    return static_cast<int>(
        syscall(SYS_seccomp, SECCOMP_SET_MODE_FILTER,
                SECCOMP_FILTER_FLAG_NEW_LISTENER | SECCOMP_FILTER_FLAG_SPEC_ALLOW | more, &filter));
  };
  const unsigned more = has_level || !TrapsHoldSignals() ? 0 : kHoldsSignals;
  const int listener = install(more);
  if (listener >= 0 || errno != EACCES) return listener;
  // Without rights over others a filter must not outlive a set-uid exec.
  prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
  return install(more);
}

int WhyNoTrap() {
  const pid_t child = fork();
  if (child == 0) {
    const int error = InstallTrap({}) >= 0 ? 0 : errno;
    // Nobody would answer the end of the process, which is trapped. The end of its one thread is
    // not.
    syscall(SYS_exit, error, 0, 0, 0, 0, shm::kOwnCallMark);
  }
  int status = -1;
  if (child < 0 || waitpid(child, &status, 0) != child || !WIFEXITED(status)) return ECHILD;
  return WEXITSTATUS(status);
}

bool IsExecution(const TrappedCall& call) {
  return std::find(std::begin(kExecutions), std::end(kExecutions), call.number) !=
         std::end(kExecutions);
}

bool SendsSignal(const TrappedCall& call) {
  return std::find(std::begin(kSignals), std::end(kSignals), call.number) != std::end(kSignals);
}

bool BeginsProgram(const TrappedCall& call) { return call.number == SYS_arch_prctl; }

bool IsEnd(const TrappedCall& call) { return static_cast<std::uint32_t>(call.number) == kEnd; }

bool MakesTask(const TrappedCall& call) {
  return call.number == SYS_clone || call.number == SYS_clone3 || call.number == SYS_fork ||
         call.number == SYS_vfork;
}

}  // namespace tcs
