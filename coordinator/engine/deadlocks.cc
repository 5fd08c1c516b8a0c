#include "coordinator/engine/deadlocks.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "coordinator/engine/locks.h"

namespace tcs {

namespace {

std::string NameOf(const Task& task) {
  return task.is_further ? fmt::format("{} #{}", task.process->name, task.order)
                         : task.process->name;
}

// The thread whose lock this thread waits for without a timeout; null: none that is known.
const Task* AwaitedBy(const Task& task, const RunState& run, const FutexTable& futexes) {
  const bool waits = task.wait.has_value() && task.wait->deadline.IsNever();
  return waits ? OwnerOfAwaitedLock(task, run, futexes) : nullptr;
}

std::string SentenceOf(const std::vector<const Task*>& ring) {
  VirtualTime since;
  std::vector<std::string> parts;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    since = std::max(since, ring[i]->reached);
    parts.push_back(fmt::format("{} waits for a lock that {} has", NameOf(*ring[i]),
                                NameOf(*ring[(i + 1) % ring.size()])));
  }
  return fmt::format("{} threads are in a deadlock from {:.3f} s on: {}", ring.size(),
                     since.seconds(), fmt::join(parts, ", "));
}

}  // namespace

std::vector<std::string> DeadlocksIn(const RunState& run, const FutexTable& futexes) {
  std::map<const Task*, const Task*> awaits;
  for (const Robot& robot : run.robots) {
    for (const Task* task : robot.tasks) {
      if (const Task* owner = AwaitedBy(*task, run, futexes)) awaits[task] = owner;
    }
  }
  std::vector<std::string> sentences;
  std::set<const Task*> seen;
  for (const Robot& robot : run.robots) {
    for (const Task* task : robot.tasks) {
      std::vector<const Task*> way;
      for (const Task* at = task; at != nullptr && !seen.contains(at);) {
        seen.insert(at);
        way.push_back(at);
        const auto next = awaits.find(at);
        if (next == awaits.end()) break;
        at = next->second;
        const auto ring = std::ranges::find(way, at);
        if (ring != way.end()) sentences.push_back(SentenceOf({ring, way.end()}));
      }
    }
  }
  return sentences;
}

}  // namespace tcs
