// What a thread has coming to it of the cores that it shares with its equals: while one of n that
// want a core runs, each of its equals, asleep or not, is owed an nth of that; who runs has it.
//
// Whoever sleeps and uses less than it is owed goes before its equals when it wakes, as on Linux.
// Credit is bounded, so that a long sleep does not buy more than one turn, and so is debt, so that
// it is forgotten. Nobody gets more than its share this way: of those who want a core one's credit
// is another's debt. Pure; virtual nanoseconds.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace tcs {

class Share {
 public:
  static constexpr std::int64_t kMostNs = 1'000'000;

  // One of `sharing` equals has run for `ns`: it, or another one.
  void Earn(std::int64_t ns, std::size_t sharing) {
    owed_ns_ = std::min(kMostNs, owed_ns_ + PartOf(ns, sharing));
  }
  void Spend(std::int64_t ns) { owed_ns_ = std::max(-kMostNs, owed_ns_ - ns); }

  // Whether it goes before its equals, after another `ns` of theirs.
  bool GoesFirst(std::int64_t ns = 0, std::size_t sharing = 1) const {
    return owed_ns_ + PartOf(ns, sharing) > 0;
  }
  // How much of theirs it takes until it goes first.
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
