// For how long the coordinator sleeps while a thread runs: until the thread has to be preempted at
// its horizon, less what timers are late. Learns how late they are. Pure; the host's nanoseconds.
//
// A timer due before the kernel's next tick is programmed into the hardware when it is set and
// again when it is not needed any more: on a virtual machine that is as much as the context switch.
// So a thread that has stopped by itself long before its horizon of late gets a timer that comes
// after the tick (250 Hz). Should the thread compute on this once, the timer is like any late
// timer: the thread's clock stops at the horizon, and the rest is a debt.
#pragma once

#include <algorithm>
#include <cstdint>

namespace tcs {

class PreemptionTimer {
 public:
  static constexpr std::int64_t kShortestNs = 2'000;
  static constexpr std::int64_t kLaxNs = 4'100'000;
  // No thread computes for longer than this without the coordinator's looking: the coordinator
  // finds by its timer what is stolen and no clock tells of.
  static constexpr std::int64_t kLongestNs = kLaxNs;
  // A thread whose longest run is shorter than the time to its horizon, by this factor, stops by
  // itself.
  static constexpr std::int64_t kOftenShorter = 4;
  static constexpr double kMostLatenessNs = 50'000.0;

  // `left_ns`: until a thread that computes on is at its horizon. `longest_run_ns`: the thread's
  // longest run of late.
  std::int64_t NsToSleep(double left_ns, std::int64_t longest_run_ns) const {
    const auto ns = static_cast<std::int64_t>(std::min(left_ns, kMostLeftNs) - lateness_ns_);
    if (longest_run_ns < ns / kOftenShorter) return kLaxNs;
    return std::clamp(ns, kShortestNs, kLongestNs);
  }

  // A timer of `asked_ns` was over when `took_ns` had passed.
  void Expired(std::int64_t asked_ns, double took_ns) {
    const double late_ns =
        std::clamp(took_ns - static_cast<double>(asked_ns), 0.0, kMostLatenessNs);
    lateness_ns_ += (late_ns - lateness_ns_) / kRuns;
  }

  double lateness_ns() const { return lateness_ns_; }

  // The longest run of late, a slow decay of the longest ever, once a run has taken `run_ns`.
  static constexpr std::int64_t LongestOfLate(std::int64_t longest_run_ns, std::int64_t run_ns) {
    return std::max(run_ns, longest_run_ns - longest_run_ns / kRuns);
  }

 private:
  static constexpr double kMostLeftNs = 1e9;
  static constexpr int kRuns = 16;  // over which an average is taken

  double lateness_ns_ = 5'000;  // against a thread that computes
};

}  // namespace tcs
