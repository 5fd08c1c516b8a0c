// What the coordinator asks of the host: its clocks, real-time priority, the birth of clients.
//
// Priorities on the one CPU that everything shares (paper, section 3): the coordinator preempts
// everybody, the active thread preempts the detector, and the detector runs exactly when the active
// thread has blocked in the kernel.
#pragma once

#include <sys/types.h>
#include <time.h>

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "coordinator/os/own_computer.h"
#include "coordinator/os/trap.h"
#include "coordinator/os/unique_fd.h"
#include "shm/layout.h"

namespace tcs {

// Who is to do only what the kernel has to do for it does that at once, above the coordinator.
enum class Level : int {
  kWaiting = 10,
  kDetector = 11,
  kActive = 12,
  kCoordinator = 13,
  kKernelOnly = 14
};

// Nanoseconds per TSC tick times 2^32, measured against CLOCK_MONOTONIC_RAW since the
// process was loaded, and for at least 10 ms: it sleeps for what is missing.
std::uint64_t CalibrateTsc();

// The thread, 0 for the calling one, runs on that CPU only. While it runs on another one the caller
// sleeps until it has stopped. False if the kernel does not let it.
bool BindTo(pid_t tid, int cpu);
// To that CPU alone.
bool IsBoundTo(pid_t tid, int cpu);

// False where it is not permitted (real_time_facts.h).
bool SetLevel(pid_t tid, Level level);

// From now on SetLevel does nothing in this process and its forks, as where it is not permitted.
void UseNoLevels();

// The thread, 0 for the calling one, runs only when hardly anybody else on its CPU wants to.
// Everybody may do that.
void RunOnlyWhenIdle(pid_t tid = 0);

// Of the calling thread, at ordinary priority: its timers are not put off, and it preempts those
// that compute when it wakes, as far as the kernel lets it. Everybody may do that.
void BeWokenInTime();

// Back to ordinary scheduling.
void LeaveRealTime(pid_t tid);

// A clock of the host, in nanoseconds.
std::int64_t HostClockNs(clockid_t id);

// CPU time of a process; -1 if it has ended.
std::int64_t ProcessCpuClockNs(pid_t pid);

// CPU time of one thread of any process: where it is read, -1 if that cannot be had; and its value,
// -1 once the thread has ended.
int OpenThreadCpuClock(pid_t tid);
std::int64_t ReadThreadCpuClock(int fd);

// What a process has computed, by the kernel's own books: in its programs and in system calls.
struct ComputedTimes {
  std::int64_t user_ns = 0, system_ns = 0;
};
ComputedTimes ComputedBy(pid_t pid);

// The kernel's state letter of a thread (R, S, D, T, Z), or 'X' if it has ended.
char ThreadState(pid_t tid);

// The kernel has chosen the thread for a signal, which it handles when it runs next. Of a thread
// that waits at its gate or for the answer to a trapped call: it does not sleep any more, or no
// longer so that a signal wakes it (os/trap.h). Nothing else tells who gets a signal that is for
// the whole process. False also of a thread that is stopped or has ended.
bool IsMarkedForSignal(pid_t tid);

// True if the thread, which does not run, was preempted in its program and not in the kernel. False
// also where the kernel does not tell.
bool IsInUserMode(pid_t tid);

// -1 if the process has ended.
pid_t ParentOf(pid_t pid);

// The kernel is at the thread's end, and not through with it.
bool IsExiting(pid_t tid);
// The thread is on its way out: it was killed, or ends with its process.
bool IsDying(pid_t tid);

// How a child of this process has ended, as of waitpid, which still finds it; none if it lives.
std::optional<int> WaitStatusOf(pid_t child);
// The same of any process that nobody has reaped, as far as this one may know it.
std::optional<int> EndOf(pid_t pid);

// The signals that a thread's process catches and ignores, that the thread blocks, and that wait
// for delivery to the thread or to any of its process; bit 0 is signal 1.
struct SignalSets {
  std::uint64_t caught = 0, ignored = 0, blocked = 0, own_pending = 0, shared_pending = 0;
};
SignalSets ReadSignalSets(pid_t tid);

// As whom a thread acts, and which capabilities are in effect; bit 0 is capability 0.
struct Credentials {
  uid_t real_uid = 0, effective_uid = 0;
  std::uint64_t capabilities = 0;

  bool Has(int capability) const { return (capabilities >> capability & 1) != 0; }
};
Credentials ReadCredentials(pid_t tid);

// A resource limit that is in force for a thread, by the name that /proc/TID/limits gives it; 0 if
// the thread has ended. Everybody may read it, where prlimit wants CAP_SYS_RESOURCE for the limits
// of one who has become somebody else.
std::uint64_t ReadSoftLimit(pid_t tid, const char* name);

// With what the kernel would put into the signal of a timer; to a process, or one of its threads.
struct TimerSignalRequest {
  pid_t pid = 0, tid = 0;  // tid 0: to the process
  int number = 0, timer_id = 0, overruns = 0;
  std::int64_t value = 0;
};
void SendTimerSignal(const TimerSignalRequest& request);

// The number of the system call that a thread is in, as text; "unknown" if it is in none.
std::string ThreadSystemCall(pid_t tid);

// Of the ioctl that a thread stands in; nothing: it is in none.
std::optional<int> DescriptorOfIoctl(pid_t tid);

// The file that a process executes; "pid N" if that cannot be had.
std::string ProgramOf(pid_t pid);

std::vector<pid_t> ThreadsOf(pid_t pid);
// -1 if it has ended.
pid_t ProcessOfThread(pid_t tid);
// 0 if nobody traces it.
pid_t TracerOf(pid_t pid);
bool IsThreadOf(pid_t pid, pid_t tid);

// Whether it is a child of that one, or a child of its children, and so on.
bool DescendsFrom(pid_t pid, pid_t ancestor);

int OpenPidfd(pid_t pid);
// A copy of another process's descriptor: pidfd_getfd. -1: errno is set.
int DuplicateFd(int pidfd, int fd);
// The errno by which the kernel refuses pidfd_getfd to this process, whoever is asked about, as a
// container's seccomp profile does; 0 if it does not.
int WhyNoDuplicates();
// The errno by which the kernel keeps this process from what is in the memory of a child of its; 0
// if it does not.
int WhyNoLooksInto(pid_t pid);

std::vector<pid_t> ChildrenOf(pid_t pid);

// The errno by which the kernel refuses SpawnRequest::fixed_layout; 0 if it does not, or gives all
// processes the same layout.
int WhyNoFixedLayout();

// Tells a thread by a signal, which its shim has a handler for, to go to its gate. `dispatch` is
// its last one: in another one the signal says nothing. It is there once it has notified, and may
// never be.
void SendToGate(pid_t pid, pid_t tid, std::uint64_t dispatch);
// Has the thread look whether it spins, once it runs.
inline void AskWhere(pid_t pid, pid_t tid) { SendToGate(pid, tid, shm::kAsksWhere); }

struct SpawnRequest {
  std::vector<std::string> command;
  std::string working_directory;  // empty: unchanged
  std::map<std::string, std::string> environment;
  std::string log_stdout, log_stderr;     // empty: inherited
  bool fixed_layout = false;              // no address-space randomisation
  std::vector<pid_t> guarded;             // processes that it is not to touch
  TrappedToo trapped_too;                 // (trap.h)
  const OwnComputer* computer = nullptr;  // null: the host
};

struct Spawned {
  pid_t pid = -1;  // -1: errno is set
  // Where its futex calls arrive, and those of all that it starts; none: nowhere, errno says why.
  UniqueFd trap;
};

// The new process, at Level::kWaiting on the coordinator's CPU, killed with the coordinator.
Spawned Spawn(const SpawnRequest& request);

}  // namespace tcs
