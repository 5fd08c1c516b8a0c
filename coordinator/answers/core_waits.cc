#include "coordinator/answers/core_waits.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "coordinator/answers/by_number.h"

namespace tcs {

void CoreWaits::Add(int thread, const Slice& slice, Waiting& waiting) {
  const std::int64_t ns = slice.end_ns - std::max(slice.start_ns, waiting.since_ns);
  if (ns <= 0) return;
  (slice.thread == thread ? waiting.times.own_ns : waiting.times.others_ns[slice.client]) += ns;
}

void CoreWaits::Ready(const Of& who, std::int64_t at_ns) {
  Waiting& waiting = PlaceOf(waiting_, who.thread);
  OfRobot& robot = PlaceOf(robots_, who.robot);
  if (!waiting.is_ready) robot.ready.push_back(who.thread);
  waiting = {true, who.robot, at_ns, {}};
  if (robot.latest_end_ns <= at_ns) return;
  for (const Slice& slice : robot.slices) Add(who.thread, slice, waiting);
}

void CoreWaits::Ran(const Of& who, std::int64_t start_ns, std::int64_t end_ns) {
  OfRobot& robot = PlaceOf(robots_, who.robot);
  const Slice slice{who.thread, who.client, start_ns, end_ns};
  for (const int thread : robot.ready) Add(thread, slice, PlaceOf(waiting_, thread));
  if (robot.slices.size() == kMostSlices) robot.slices.pop_front();
  robot.slices.push_back(slice);
  robot.latest_end_ns = std::max(robot.latest_end_ns, end_ns);
}

CoreWaits::Times CoreWaits::Stop(int thread) {
  Waiting& waiting = PlaceOf(waiting_, thread);
  if (!waiting.is_ready) return {};
  std::erase(PlaceOf(robots_, waiting.robot).ready, thread);
  waiting.is_ready = false;
  return std::exchange(waiting.times, {});
}

std::int64_t CoreWaits::ReadySince(int thread) const {
  const auto number = static_cast<std::size_t>(thread);
  return number < waiting_.size() && waiting_[number].is_ready ? waiting_[number].since_ns : -1;
}

ByClient CoreWaits::Shares(ByClient times_ns, std::int64_t most_ns) {
  most_ns = std::max<std::int64_t>(0, most_ns);
  std::int64_t left_of_all_ns = times_ns.TotalNs();
  if (left_of_all_ns <= most_ns) return times_ns;
  // Each client gets its share of the time that is left, so that no nanosecond is lost.
  for (auto& [client, ns] : times_ns) {
    const auto share =
        static_cast<std::int64_t>(static_cast<double>(most_ns) * static_cast<double>(ns) /
                                  static_cast<double>(left_of_all_ns));
    left_of_all_ns -= std::exchange(ns, left_of_all_ns == ns ? most_ns : share);
    most_ns -= ns;
  }
  times_ns.DropZeros();
  return times_ns;
}

}  // namespace tcs
