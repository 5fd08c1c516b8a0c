// For how long threads run where they share something: each turn of equals on a core is a quantum,
// unless an equal wakes before, and a core goes as far as cores may be apart. From a seed all three
// lengths are a little more or less, the turns a quantum on average.
//
// Under set costs a loop of a program takes the same time each round. Turns of one length, or
// sleeps of one length beside it, would end it at the same place each time: with a lock held, say,
// so that the thread that runs next finds the lock taken for ever. Pure: for a given thread, or
// core, and time the length is always the same.
#pragma once

#include <cstdint>
#include <optional>

#include "shm/draws.h"
#include "shm/time_kinds.h"

namespace tcs {

class TurnLengths {
 public:
  static constexpr VirtualDuration kSpread = VirtualDuration::Milliseconds(1);
  static constexpr VirtualDuration kSlack = VirtualDuration::Microseconds(50);  // as Linux has it

  static constexpr VirtualDuration kShortStep = VirtualDuration::Microseconds(100);

  // No seed: all lengths are the same.
  explicit TurnLengths(std::optional<std::uint64_t> seed) : seed_(seed) {}

  bool vary() const { return seed_.has_value(); }

  // The length of a turn that begins at `begin` and is to be of `quantum`: up to half a millisecond
  // more or less.
  VirtualDuration OfTurn(int thread, VirtualTime begin, VirtualDuration quantum) const {
    if (!vary()) return quantum;
    return quantum - kSpread / 2 + Drawn(kSpread, static_cast<std::uint64_t>(thread), begin);
  }
  // A thread whose sleep is over at `due` takes the core from an equal so much later.
  VirtualDuration SlackOf(int thread, VirtualTime due) const {
    if (!vary()) return {};
    return Drawn(kSlack, static_cast<std::uint64_t>(thread) << 32, due);
  }
  // How far a core goes at once, by which other cores of the robot may be behind: half to all of
  // `most`, where `most` is not short.
  VirtualDuration OfStep(std::size_t core, VirtualTime begin, VirtualDuration most) const {
    if (!vary() || most <= kShortStep) return most;
    return most / 2 + Drawn(most - most / 2, ~static_cast<std::uint64_t>(core), begin);
  }

 private:
  VirtualDuration Drawn(VirtualDuration below, std::uint64_t whose, VirtualTime when) const {
    if (below <= VirtualDuration()) return {};
    shm::Draws draws;
    draws.Seed(*seed_ + whose * 0x9e3779b97f4a7c15);
    draws.Seed(draws.Next() + static_cast<std::uint64_t>(when.ns()));
    return VirtualNs(
        static_cast<std::int64_t>(draws.Next() % static_cast<std::uint64_t>(below.ns())));
  }

  std::optional<std::uint64_t> seed_;
};

}  // namespace tcs
