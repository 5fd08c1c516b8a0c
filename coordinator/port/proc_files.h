// Facts that the kernel tells of threads and processes in /proc, of those of a run as of any other.
// A fact about a thread that runs meanwhile may be over when it is read.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace tcs {

// The time that a process has computed, by the kernel's own books: in its programs and in system
// calls.
struct ComputedTimes {
  std::int64_t user_ns = 0, system_ns = 0;
};
ComputedTimes ComputedBy(pid_t pid);

// The kernel's state letter of a thread (R, S, D, T, Z), or 'X' if it has ended.
char ThreadState(pid_t tid);

// The kernel has chosen the thread for a signal, which it handles when it runs next. For a thread
// that waits at its gate or for the answer to a trapped call: the thread does not sleep any more,
// or no longer so that a signal wakes it (os/trap.h). Nothing else tells which thread gets a signal
// that is for the whole process. False also of a thread that is stopped or has ended.
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

// How a child of this process has ended, as of waitpid, which still finds the child; none if the
// child lives.
std::optional<int> WaitStatusOf(pid_t child);
// The same of any process that nobody has reaped, as far as this process may know it.
std::optional<int> EndOf(pid_t pid);

// The signals that a thread's process catches and ignores, that the thread blocks, and that wait
// for delivery to the thread or to any of its process; bit 0 is signal 1.
struct SignalSets {
  std::uint64_t caught = 0, ignored = 0, blocked = 0, own_pending = 0, shared_pending = 0;
};
SignalSets ReadSignalSets(pid_t tid);

// The user as whom a thread acts, and the capabilities that are in effect; bit 0 is capability 0.
struct Credentials {
  uid_t real_uid = 0, effective_uid = 0;
  std::uint64_t capabilities = 0;

  bool Has(int capability) const { return (capabilities >> capability & 1) != 0; }
};
Credentials ReadCredentials(pid_t tid);

// A resource limit that is in force for a thread, by the name that /proc/TID/limits gives it; 0 if
// the thread has ended. Every process may read it, where prlimit wants CAP_SYS_RESOURCE for the
// limits of a process that has changed users.
std::uint64_t ReadSoftLimit(pid_t tid, const char* name);

// The number of the system call that a thread is in, as text; "unknown" if it is in none.
std::string ThreadSystemCall(pid_t tid);

// The descriptor of the ioctl that a thread is in; none: the thread is in no ioctl.
std::optional<int> DescriptorOfIoctl(pid_t tid);

// The file that a process executes; "pid N" if that cannot be had.
std::string ProgramOf(pid_t pid);

std::vector<pid_t> ThreadsOf(pid_t pid);
// -1 if the thread has ended.
pid_t ProcessOfThread(pid_t tid);
// 0 if nobody traces the process.
pid_t TracerOf(pid_t pid);
bool IsThreadOf(pid_t pid, pid_t tid);

// Whether the process is `ancestor`, or a child of it, or a child of its children, and so on.
bool DescendsFrom(pid_t pid, pid_t ancestor);

std::vector<pid_t> ChildrenOf(pid_t pid);

}  // namespace tcs
