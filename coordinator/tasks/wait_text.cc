#include "coordinator/tasks/wait_text.h"

#include <fmt/format.h>
#include <sys/epoll.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>

#include "coordinator/os/open_files.h"
#include "coordinator/port/proc_files.h"
#include "coordinator/tasks/run_state.h"

namespace tcs {

namespace {

std::string KindOf(int fd) {
  struct stat status {};
  if (fstat(fd, &status) != 0) return "gone";
  if (S_ISFIFO(status.st_mode)) return "a pipe";
  if (S_ISSOCK(status.st_mode)) return "a socket";
  if (S_ISCHR(status.st_mode)) return isatty(fd) ? "a terminal" : "a device";
  if (IsAnonymous(getpid(), fd, kEpollSet)) return "an epoll set";
  char target[64] = {};
  const ssize_t size =
      readlink(fmt::format("/proc/self/fd/{}", fd).c_str(), target, sizeof target - 1);
  return "a " + std::string(target, static_cast<std::size_t>(std::max<ssize_t>(size, 0)));
}

std::string TextOf(const KernelObject& object) {
  if (object.kind == static_cast<std::int64_t>(shm::KernelObjectKind::kSemaphores)) {
    return "for a System V semaphore";
  }
  if (object.kind == static_cast<std::int64_t>(shm::KernelObjectKind::kMessages)) {
    return "at a System V message queue";
  }
  return "for room in a listener's backlog";
}

// The reason for which the kernel holds the thread, as far as the system call says it.
std::string TextOfKernelWait(const std::string& call) {
  constexpr std::pair<int, const char*> kWaits[] = {
      {SYS_semop, "waits for a System V semaphore"},
      {SYS_semtimedop, "waits for a System V semaphore"},
      {SYS_msgsnd, "waits for room in a System V message queue"},
      {SYS_msgrcv, "waits for a message at a System V message queue"},
      {SYS_flock, "waits for a lock of a file"},
      {SYS_fcntl, "waits for a lock of a file"}};
  for (const auto& [number, text] : kWaits) {
    if (call == std::to_string(number)) return text;
  }
  return fmt::format("is in system call {}, whose end only the kernel knows", call);
}

// The descriptors as the program numbers them, as far as the program has said so.
std::string DescriptorsOf(const Task& task, const awaited::Descriptors& wait) {
  const bool raw = task.wait->is_in_trapped_call;
  const shm::Notification& note = SlotOf(task).note;
  const bool writes = (raw ? 0 : note.fds[0].events & EPOLLOUT) != 0;
  const std::string what = writes ? "room to write" : "input";
  if (wait.fds.empty()) return "waits for " + what;
  const std::string kind = KindOf(wait.fds[0].get());
  if (wait.fds.size() > 1) {
    return fmt::format("waits for {} of {} descriptors", writes ? "one" : "input at one",
                       wait.fds.size());
  }
  if (raw && !wait.transfers) return fmt::format("waits for {} ({})", what, kind);
  const auto number = raw ? static_cast<std::int32_t>(task.trapped_call.args[0]) : note.fds[0].fd;
  return fmt::format("waits for {} at descriptor {} ({})", what, number, kind);
}

}  // namespace

WaitText TextOfWait(const Task& task, bool has_child) {
  if (task.process->stopped || ThreadState(task.tid) == 'T') {
    return {0, "is stopped by a signal (SIGCONT lets it go on)"};
  }
  if (task.state == TaskState::kUnseen) {
    return {1, TextOfKernelWait(ThreadSystemCall(task.tid))};
  }
  if (task.state == TaskState::kStarting) return {8, "is being started"};
  if (task.state != TaskState::kWaiting) return {9, "is about to act"};
  return TextOfAwaited(task, has_child);
}

WaitText TextOfAwaited(const Task& task, bool has_child) {
  if (const auto* wait = task.Awaits<awaited::Descriptors>(); wait != nullptr) {
    return {2, DescriptorsOf(task, *wait)};
  }
  if (const auto* wait = task.Awaits<awaited::Queue>(); wait != nullptr) {
    return {2, "waits " + TextOf(wait->of)};
  }
  if (task.Awaits<awaited::Messages>() != nullptr) return {6, "waits for DDS messages"};
  if (task.Awaits<awaited::Room>() != nullptr) {
    return {3, "waits (back-pressure) until other programs have taken its DDS messages"};
  }
  if (const auto* wait = task.Awaits<awaited::Child>(); wait != nullptr) {
    return {4, wait->which > 0 ? fmt::format("waits for its child {} to end", wait->which)
                               : "waits for a child to end"};
  }
  if (const auto* wait = task.Awaits<awaited::Futex>(); wait != nullptr) {
    if (wait->names_tid > 0) return {5, fmt::format("waits for thread {}", wait->names_tid)};
    return {5, "waits for a lock or a condition that no thread gives it"};
  }
  return {7,
          has_child ? "waits for a signal, such as that of a child's end" : "waits for a signal"};
}

}  // namespace tcs
