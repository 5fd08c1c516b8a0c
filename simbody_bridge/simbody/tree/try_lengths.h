// How long a step of an island of models becomes under error control, whatever the method.
#pragma once

#include <algorithm>
#include <cstdint>

#include "simbody_bridge/simbody/kutta.h"
#include "simbody_bridge/simbody/tree/tree.h"

namespace tcs {

// In whole nanoseconds, as islands count: the next step then begins where this one ends, and its
// first derivatives are known.
inline double WholeNanoseconds(double seconds) {
  const auto ns = static_cast<std::int64_t>(seconds * 1e9);
  return ns > 0 ? VirtualDuration::Nanoseconds(ns).seconds() : seconds;
}

// `attempt` tries a step of so many seconds, no more than `limit_s`, and says how far it may be off
// (GreatestError). The last one is good enough. Throws std::runtime_error where no step is short
// enough.
template <class Attempt>
void TryLengths(const SimbodyTree& tree, double accuracy, double limit_s, IslandStep* step,
                const Attempt& attempt) {
  StepLength length(*step,
                    std::min(limit_s, std::max(kShortestStepS, tree.LongestStepFrom(step->from))));
  if (length.seconds() != step->limit.seconds()) length.Set(WholeNanoseconds(length.seconds()));
  while (!length.Judge(attempt(length.seconds()), accuracy, step)) {
    length.Set(WholeNanoseconds(length.seconds()));
  }
}

}  // namespace tcs
