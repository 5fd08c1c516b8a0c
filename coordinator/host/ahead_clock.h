// The time that a thread has computed since it was sent to another processor of the host, where
// nobody stops it. The thread's CPU clock is known for some instants. From one instant to the next
// the TSC carries on, which tells when the thread may have computed something, so that it is worth
// while to look. The thread need not have computed, for others may have taken that processor since.
//
// The host's nanoseconds. One thread says what is known. Another thread may ask at the same time;
// it waits if the first one is interrupted in the midst.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>

namespace tcs {

class AheadClock {
 public:
  // The time that the kernel takes to wake a processor that sleeps, and to move a thread there. The
  // thread begins that much later.
  static constexpr std::int64_t kWayNs = 100'000;
  // Other threads may take so much time before it is worth while to leave the processor to them: at
  // least this time, and at least this part of all the time that there was.
  static constexpr std::int64_t kMostTakenNs = 5'000'000;
  static constexpr std::int64_t kMostTakenOf = 4;
  // Without a look for so long nothing is known any more.
  static constexpr std::int64_t kMostUnknownNs = 3'000'000;
  static constexpr std::int64_t kLostNs = 20'000'000;

  // The thread has been sent just now. No other thread asks meanwhile.
  void Start() {
    rested_ns_.store(0);
    rests_.store(false);
    Know(0, 0);
  }

  // At `at_ns` the thread had computed `computed_ns`. Times count from when the thread was sent.
  void Know(std::int64_t at_ns, std::int64_t computed_ns) {
    ++version_;
    at_ns_.store(at_ns);
    computed_ns_.store(computed_ns);
    ++version_;
  }

  // From the last look on, the thread is kept from computing, until `at_ns`. Meanwhile the TSC does
  // not carry on, and that time was not taken by others.
  void Rest() { rests_.store(true); }
  void GoOn(std::int64_t at_ns) {
    rested_ns_.store(rested_ns_.load() + at_ns - at_ns_.load());
    Know(at_ns, computed_ns_.load());
    rests_.store(false);
  }
  bool rests() const { return rests_.load(); }

  // The time that the thread has computed for certain.
  std::int64_t computed_ns() const { return Last().computed_ns; }
  // The time that the thread has computed by `now_ns` unless others had the processor, but not more
  // than `most_ns`.
  std::int64_t MayHaveComputedBy(std::int64_t now_ns, std::int64_t most_ns) const {
    // In this order: what is known changes before and after a rest of the thread, but not during
    // it.
    const bool rests = rests_.load();
    const auto [at_ns, computed_ns] = Last();
    if (rests) return computed_ns;
    const std::int64_t since_ns =
        std::clamp<std::int64_t>(now_ns - std::max(at_ns, kWayNs), 0, kMostUnknownNs);
    return std::max(computed_ns, std::min(computed_ns + since_ns, most_ns));
  }

  // True if other threads have had the processor for long by then, or keep it from the thread that
  // is to look.
  bool IsStarvedBy(std::int64_t now_ns) const {
    const auto [at_ns, computed_ns] = Last();
    const std::int64_t taken_ns = at_ns - rested_ns_.load() - computed_ns - kWayNs;
    return (taken_ns > kMostTakenNs && taken_ns > at_ns / kMostTakenOf) || now_ns - at_ns > kLostNs;
  }

 private:
  struct Known {
    std::int64_t at_ns, computed_ns;
  };
  // A sequence lock: odd while the two are written.
  Known Last() const {
    for (;;) {
      const std::uint32_t version = version_.load();
      const Known known{at_ns_.load(), computed_ns_.load()};
      if (version % 2 == 0 && version_.load() == version) return known;
    }
  }

  std::atomic<std::uint32_t> version_{0};
  std::atomic<std::int64_t> at_ns_{0}, computed_ns_{0}, rested_ns_{0};
  std::atomic<bool> rests_{false};
};

}  // namespace tcs
