#include "coordinator/engine/standstill_watch.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <utility>

#include "coordinator/os/open_files.h"
#include "coordinator/port/proc_files.h"
#include "coordinator/tasks/wait_text.h"

namespace tcs {

namespace {

constexpr std::size_t kMostNamed = 3;

std::string NameOf(pid_t pid) {
  const std::string program = ProgramOf(pid);
  return fmt::format("{} (pid {})", program.substr(program.rfind('/') + 1), pid);
}

std::string NameOf(const Process& process) {
  return process.is_client ? process.name : NameOf(process.pid);
}

// The first few entries, and how many more there are.
std::string Joined(const std::vector<std::string>& all) {
  std::string text;
  for (std::size_t i = 0; i < std::min(all.size(), kMostNamed); ++i) {
    text += (i == 0 ? "" : "; ") + all[i];
  }
  if (all.size() > kMostNamed) text += fmt::format("; and {} more", all.size() - kMostNamed);
  return text;
}

}  // namespace

// The programs that time waits for, and what for, one phrase for each program.
std::vector<std::string> StandstillWatch::WhatIsAwaited() const {
  std::vector<std::string> awaited;
  for (const Process& process : run_.table.processes()) {
    if (process.dead) continue;
    const bool has_child = run_.table.HasChild(process);
    WaitText first{10, {}};
    for (const Task* task : process.robot->tasks) {
      if (task->process == &process) first = std::min(first, TextOfWait(*task, has_child));
    }
    if (!first.text.empty()) awaited.push_back(NameOf(process) + ' ' + first.text);
  }
  for (const auto& [pid, child] : unregistered_children_.living()) {
    awaited.push_back(NameOf(pid) + ", which never registered with tcs, goes on");
  }
  return awaited;
}

// A program that has a terminal's user to wait for looks as it does without tcs.
bool StandstillWatch::AwaitsTerminal() const {
  return run_.options.output_directory.empty() &&
         std::any_of(run_.table.tasks().begin(), run_.table.tasks().end(), [](const Task& task) {
           const auto* wait = task.Awaits<awaited::Descriptors>();
           return wait != nullptr && wait->has_terminal;
         });
}

// The programs that compute without tcs's knowing of it: a program with threads that never
// registered, a child of a bare clone.
std::vector<std::string> StandstillWatch::WhatComputesUnregistered() const {
  std::vector<std::string> computing;
  for (const Process& process : run_.table.processes()) {
    if (process.has_unregistered_threads && !process.dead) {
      computing.push_back("a thread of " + NameOf(process));
    }
  }
  for (const auto& [pid, child] : unregistered_children_.living()) {
    computing.push_back(NameOf(pid));
  }
  return computing;
}

void StandstillWatch::NoteStandstill(HostTime now, VirtualTime furthest) {
  const bool has_acted =
      run_.report.switches != standstill_.dispatches || furthest != standstill_.furthest;
  // Once the user has typed something, the program that reads it has yet to be dispatched.
  if (has_acted || AwaitsTerminal()) {
    standstill_ = {run_.report.switches, furthest, now, {}};
    return;
  }
  const HostDuration since = now - std::exchange(standstill_.looked_at, now);
  standstill_.stood += std::min(since, kMostBetweenLooks);
  if (standstill_.stood < kPatience) return;
  has_said_standstill_ = true;
  const std::string why =
      std::any_of(run_.exiting.begin(), run_.exiting.end(), IsExiting)
          ? "it waits for the kernel, which is about to end a thread"
      : unregistered_.AnyRuns() || unregistered_children_.AnyRuns()
          ? "it waits for threads or processes that tcs does not manage: " +
                Joined(WhatComputesUnregistered())
          : "only input from outside could make it go on; " + Joined(WhatIsAwaited());
  run_.options.on_notice(
      fmt::format("virtual time has stood still at {:.3f} s for {:.0f} s: {}; Ctrl-C ends the run",
                  furthest.seconds(), standstill_.stood.seconds(), why));
}

// A program alone has ended, and the run goes on for the processes that it has left in the
// background.
void StandstillWatch::NoteLeftBehind(HostTime now) {
  std::vector<std::string> ended, left;
  for (const Process& process : run_.table.processes()) {
    if (process.is_client) {
      if (!process.dead) return;
      ended.push_back(process.name);
    } else if (!process.dead) {
      left.push_back(NameOf(process));
    }
  }
  for (const auto& [pid, child] : unregistered_children_.living()) {
    left.push_back(NameOf(pid));
  }
  if (ended.empty() || left.empty()) return;
  if (!alone_since_.has_value()) alone_since_ = now;
  if (now - *alone_since_ < kPatience) return;
  has_said_left_behind_ = true;
  run_.options.on_notice(
      fmt::format("{} has ended; the run goes on for the background processes that it has left: "
                  "{}; Ctrl-C ends these, too",
                  Joined(ended), Joined(left)));
}

void StandstillWatch::Look(HostTime now, VirtualTime furthest) {
  if (!has_said_left_behind_ && run_.end.IsNever()) NoteLeftBehind(now);
  if (!has_said_standstill_) NoteStandstill(now, furthest);
}

}  // namespace tcs
