#include "coordinator/calls/syscall_child_waits.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <stdlib.h>
#include <sys/syscall.h>
#include <sys/wait.h>

#include <algorithm>
#include <fstream>
#include <string>

#include "coordinator/port/proc_files.h"
#include "coordinator/port/traps.h"

namespace tcs {

namespace {

// What a descriptor of a process is: whose it is (0: it is no such descriptor, or the process has
// ended), and whether a wait on it waits, rather than fail with EAGAIN (PIDFD_NONBLOCK).
struct ProcessDescriptor {
  pid_t pid = 0;
  bool waits = true;
};

ProcessDescriptor DescriptorOf(pid_t tid, int number) {
  ProcessDescriptor found;
  std::ifstream info(fmt::format("/proc/{}/fdinfo/{}", tid, number));
  for (std::string line; std::getline(info, line);) {
    if (line.rfind("flags:", 0) == 0) {
      found.waits = (strtol(line.c_str() + 6, nullptr, 8) & O_NONBLOCK) == 0;
    }
    if (line.rfind("Pid:", 0) == 0) found.pid = std::max(0, atoi(line.c_str() + 4));
  }
  return found;
}

}  // namespace

void SyscallChildWaits::ForgetNews(const Process& parent) {
  for (Process& child : run_.table.processes()) {
    if (child.parent == parent.pid) child.stop_is_news = child.continue_is_news = false;
  }
}

void SyscallChildWaits::Await(Task& task, const TrappedCall& call) {
  const std::uint64_t options = call.args[call.number == SYS_wait4 ? 2 : 3];
  task.trap_continues = true;
  const bool stops = (options & (WUNTRACED | WCONTINUED)) != 0;
  unregistered_.LookFor(*task.process);
  const bool has_living =
      unregistered_.AreOf(*task.process) ||
      std::any_of(run_.table.processes().begin(), run_.table.processes().end(),
                  [&](const Process& p) { return p.parent == task.process->pid && !p.dead; });
  constexpr std::uint64_t kOfDescriptor = 3;  // P_PIDFD, which glibc has since 2.36
  ProcessDescriptor descriptor;
  if (call.number == SYS_waitid && call.args[0] == kOfDescriptor) {
    descriptor = DescriptorOf(task.tid, static_cast<int>(call.args[1]));
  }
  if ((options & WNOHANG) != 0 || !descriptor.waits || !has_living) {
    waker_.HoldInCall(task, shm::NotificationKind::kRead);
    return;
  }
  pid_t which = descriptor.pid;  // 0: any
  if (call.number == SYS_wait4) which = std::max(0, static_cast<int>(call.args[0]));
  if (call.number == SYS_waitid && call.args[0] == P_PID) which = static_cast<int>(call.args[1]);
  if (which > 0 && task.process->pid_namespace != 0) {
    const Process* named = run_.table.NamedProcess(*task.process, which);
    which = named == nullptr ? 0 : named->pid;
  }
  const bool has_news = std::any_of(
      run_.table.processes().begin(), run_.table.processes().end(), [&](const Process& p) {
        if (p.parent != task.process->pid || p.is_client || (which != 0 && p.pid != which))
          return false;
        if (p.dead) return ThreadState(p.pid) == 'Z';
        return ((options & WUNTRACED) != 0 && p.stop_is_news) ||
               ((options & WCONTINUED) != 0 && p.continue_is_news);
      });
  if (stops) ForgetNews(*task.process);
  if (has_news) return waker_.HoldInCall(task, shm::NotificationKind::kRead);
  waker_.Wait(task, {awaited::Child{which, stops}, VirtualTime::Never(), true});
}

}  // namespace tcs
