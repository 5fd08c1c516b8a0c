// What a user is told, once, who sees nothing happen: whom the run waits for, and what that one
// waits for. Real time; nothing of this changes what the run does.
#include <fmt/format.h>
#include <sys/epoll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <string>
#include <vector>

#include "coordinator/core/engine.h"
#include "coordinator/os/host.h"
#include "coordinator/os/open_files.h"

namespace tcs {

namespace {

// Shorter waits for what comes from outside are usual.
constexpr std::int64_t kPatienceNs = 5'000'000'000;
constexpr std::size_t kMostNamed = 3;

double Seconds(std::int64_t ns) { return static_cast<double>(ns) * 1e-9; }

std::string NameOf(pid_t pid) {
  const std::string program = ProgramOf(pid);
  return fmt::format("{} (pid {})", program.substr(program.rfind('/') + 1), pid);
}

std::string NameOf(const Process& process) {
  return process.is_client ? process.name : NameOf(process.pid);
}

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

std::string NameOf(const KernelObject& object) {
  if (object.kind == static_cast<std::int64_t>(shm::WaitKey::kSemaphores)) {
    return "for a System V semaphore";
  }
  if (object.kind == static_cast<std::int64_t>(shm::WaitKey::kMessages)) {
    return "at a System V message queue";
  }
  return "for room in a listener's backlog";
}

// The first few of them, and how many more there are.
std::string Joined(const std::vector<std::string>& all) {
  std::string text;
  for (std::size_t i = 0; i < std::min(all.size(), kMostNamed); ++i) {
    text += (i == 0 ? "" : "; ") + all[i];
  }
  if (all.size() > kMostNamed) text += fmt::format("; and {} more", all.size() - kMostNamed);
  return text;
}

}  // namespace

// The descriptors as the program numbers them, as far as it has said so.
std::string Engine::AwaitedDescriptors(const Task& task, const awaited::Descriptors& wait) const {
  const bool raw = task.wait->is_in_trapped_call;
  const shm::Notification& note = Slot(task).note;
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

// What the thread waits for; what others of its own program can end comes last.
std::pair<int, std::string> Engine::WhatItAwaits(const Task& task) const {
  if (task.process->stopped || ThreadState(task.tid) == 'T') {
    return {0, "is stopped by a signal (SIGCONT lets it go on)"};
  }
  if (task.state == TaskState::kUnseen) {
    return {1, fmt::format("is in system call {}, whose end only the kernel knows",
                           ThreadSystemCall(task.tid))};
  }
  if (task.state == TaskState::kStarting) return {8, "is being started"};
  if (task.state != TaskState::kWaiting) return {9, "is about to act"};
  if (const auto* wait = task.Awaits<awaited::Descriptors>(); wait != nullptr) {
    return {2, AwaitedDescriptors(task, *wait)};
  }
  if (const auto* wait = task.Awaits<awaited::Queue>(); wait != nullptr) {
    return {2, "waits " + NameOf(wait->of)};
  }
  if (task.Awaits<awaited::Messages>() != nullptr) return {6, "waits for DDS messages"};
  if (task.Awaits<awaited::Room>() != nullptr) {
    return {3, "waits until others have taken its DDS messages"};
  }
  if (const auto* wait = task.Awaits<awaited::Child>(); wait != nullptr) {
    return {4, wait->which > 0 ? fmt::format("waits for its child {} to end", wait->which)
                               : "waits for a child to end"};
  }
  if (const auto* wait = task.Awaits<awaited::Futex>(); wait != nullptr) {
    if (wait->names_tid > 0) return {5, fmt::format("waits for thread {}", wait->names_tid)};
    return {5, "waits for a lock or a condition that nobody gives it"};
  }
  const bool has_child = std::any_of(table_.processes().begin(), table_.processes().end(),
                                     [&task](const Process& process) {
                                       return !process.dead && process.parent == task.process->pid;
                                     });
  return {7, has_child ? "waits for a signal, as of a child's end" : "waits for a signal"};
}

// Whom time waits for, and what for, one phrase for each program.
std::vector<std::string> Engine::WhatIsAwaited() const {
  std::vector<std::string> awaited;
  for (const Process& process : table_.processes()) {
    if (process.dead) continue;
    std::pair<int, std::string> first{10, {}};
    for (const Task* task : process.robot->tasks) {
      if (task->process == &process) first = std::min(first, WhatItAwaits(*task));
    }
    if (!first.second.empty()) awaited.push_back(NameOf(process) + ' ' + first.second);
  }
  for (const auto& [pid, child] : unknown_children_.living()) {
    awaited.push_back(NameOf(pid) + ", which tcs knows nothing of, goes on");
  }
  return awaited;
}

// A program that has a terminal's user to wait for looks as it does without tcs.
bool Engine::AwaitsTerminal() const {
  return options_.output_directory.empty() &&
         std::any_of(table_.tasks().begin(), table_.tasks().end(), [](const Task& task) {
           const auto* wait = task.Awaits<awaited::Descriptors>();
           return wait != nullptr && wait->has_terminal;
         });
}

// Who computes without tcs's knowing of it: a program with threads that never registered, a child
// of a bare clone.
std::vector<std::string> Engine::ComputingStrangers() const {
  std::vector<std::string> strangers;
  for (const Process& process : table_.processes()) {
    if (process.has_unmanaged_threads && !process.dead) {
      strangers.push_back("a thread of " + NameOf(process));
    }
  }
  for (const auto& [pid, child] : unknown_children_.living()) {
    strangers.push_back(NameOf(pid));
  }
  return strangers;
}

void Engine::NoteStandstill(std::int64_t now_ns) {
  Standstill now{report_.switches, FurthestNs(), now_ns};
  if (now.dispatches != standstill_.dispatches || now.at_ns != standstill_.at_ns) {
    standstill_ = now;
    return;
  }
  if (now_ns - standstill_.since_ns < kPatienceNs || AwaitsTerminal()) return;
  has_said_standstill_ = true;
  const std::string why =
      UnmanagedRun() ? "it waits for what computes without tcs's knowing of it: " +
                           Joined(ComputingStrangers())
                     : "nothing can happen any more but from outside; " + Joined(WhatIsAwaited());
  options_.on_notice(
      fmt::format("virtual time has stood still at {:.3f} s for {:.0f} s: {}; Ctrl-C ends the run",
                  Seconds(now.at_ns), Seconds(now_ns - standstill_.since_ns), why));
}

// A program alone has ended, and the run goes on for what it has left in the background.
void Engine::NoteLeftBehind(std::int64_t now_ns) {
  std::vector<std::string> ended, left;
  for (const Process& process : table_.processes()) {
    if (process.is_client) {
      if (!process.dead) return;
      ended.push_back(process.name);
    } else if (!process.dead) {
      left.push_back(NameOf(process));
    }
  }
  for (const auto& [pid, child] : unknown_children_.living()) {
    left.push_back(NameOf(pid));
  }
  if (ended.empty() || left.empty()) return;
  if (alone_since_ns_ < 0) alone_since_ns_ = now_ns;
  if (now_ns - alone_since_ns_ < kPatienceNs) return;
  has_said_left_behind_ = true;
  options_.on_notice(
      fmt::format("{} has ended; the run goes on for what it has left: {}; Ctrl-C "
                  "ends it, too",
                  Joined(ended), Joined(left)));
}

void Engine::LookForStandstill() {
  const std::int64_t now_ns = HostClockNs(CLOCK_MONOTONIC);
  if (!has_said_left_behind_ && end_ns_ == shm::kNeverNs) NoteLeftBehind(now_ns);
  if (!has_said_standstill_) NoteStandstill(now_ns);
}

}  // namespace tcs
