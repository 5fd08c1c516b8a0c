// The time that a thread is owed of the cores that it shares with its equals: while one of n
// threads that want a core runs, each of its equals, asleep or not, is owed an nth of that time;
// the thread that runs has the time.
//
// A thread that sleeps and uses less than it is owed goes before its equals when it wakes, as on
// Linux. Credit is bounded, so that a long sleep does not buy more than one turn, and so is debt,
// so that it is forgotten. No thread gets more than its share this way: among the threads that want
// a core, the credit of one is the debt of another. Pure; virtual nanoseconds.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace tcs {

class Share {
 public:
  static constexpr std::int64_t kMostNs = 1'000'000;

  // One of `sharing` equals has run for `ns`: this thread, or another one.
  void Earn(std::int64_t ns, std::size_t sharing) {
    owed_ns_ = std::min(kMostNs, owed_ns_ + PartOf(ns, sharing));
  }
  void Spend(std::int64_t ns) { owed_ns_ = std::max(-kMostNs, owed_ns_ - ns); }

  // Whether the thread goes before its equals, after they have run for another `ns`.
  bool GoesFirst(std::int64_t ns = 0, std::size_t sharing = 1) const {
    return owed_ns_ + PartOf(ns, sharing) > 0;
  }
  // How long its equals have to run until the thread goes first.
  std::int64_t NsUntilFirst(std::size_t sharing) const {
    if (owed_ns_ > 0) return 0;
    return (1 - owed_ns_) * static_cast<std::int64_t>(std::max<std::size_t>(sharing, 1));
  }
  std::int64_t owed_ns() const { return owed_ns_; }

 private:
  static std::int64_t PartOf(std::int64_t ns, std::size_t sharing) {
    return ns / static_cast<std::int64_t>(std::max<std::size_t>(sharing, 1));
  }

  std::int64_t owed_ns_ = 0;
};

}  // namespace tcs
