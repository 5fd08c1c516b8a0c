#include "coordinator/answers/core_waits.h"

#include <algorithm>
#include <utility>

namespace tcs {

void CoreWaits::Add(int thread, const Slice& slice, Waiting& waiting) {
  const std::int64_t ns = slice.end_ns - std::max(slice.start_ns, waiting.since_ns);
  if (ns <= 0) return;
  (slice.thread == thread ? waiting.times.own_ns : waiting.times.others_ns[slice.client]) += ns;
}

void CoreWaits::Ready(const Of& who, std::int64_t at_ns) {
  Waiting& waiting = waiting_[who.thread] = {who.robot, at_ns, {}};
  OfRobot& robot = robots_[who.robot];
  robot.ready.insert(who.thread);
  for (const Slice& slice : robot.slices) Add(who.thread, slice, waiting);
}

void CoreWaits::Ran(const Of& who, std::int64_t start_ns, std::int64_t end_ns) {
  OfRobot& robot = robots_[who.robot];
  const Slice slice{who.thread, who.client, start_ns, end_ns};
  for (const int thread : robot.ready) Add(thread, slice, waiting_[thread]);
  if (robot.slices.size() == kMostSlices) robot.slices.pop_front();
  robot.slices.push_back(slice);
}

CoreWaits::Times CoreWaits::Stop(int thread) {
  const auto found = waiting_.find(thread);
  if (found == waiting_.end()) return {};
  robots_[found->second.robot].ready.erase(thread);
  Times times = std::move(found->second.times);
  waiting_.erase(found);
  return times;
}

std::int64_t CoreWaits::ReadySince(int thread) const {
  const auto found = waiting_.find(thread);
  return found == waiting_.end() ? -1 : found->second.since_ns;
}

CoreWaits::ByClient CoreWaits::Shares(ByClient times_ns, std::int64_t most_ns) {
  most_ns = std::max<std::int64_t>(0, most_ns);
  std::int64_t left_of_all_ns = 0;
  for (const auto& [client, ns] : times_ns) left_of_all_ns += ns;
  if (left_of_all_ns <= most_ns) return times_ns;
  // Each has its share of what is left, so that no nanosecond is lost.
  for (auto& [client, ns] : times_ns) {
    const auto share =
        static_cast<std::int64_t>(static_cast<double>(most_ns) * static_cast<double>(ns) /
                                  static_cast<double>(left_of_all_ns));
    left_of_all_ns -= std::exchange(ns, left_of_all_ns == ns ? most_ns : share);
    most_ns -= ns;
  }
  std::erase_if(times_ns, [](const auto& of) { return of.second == 0; });
  return times_ns;
}

}  // namespace tcs
