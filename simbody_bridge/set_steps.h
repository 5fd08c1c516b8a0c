// Engines whose steps are all of one set length. Within a step the state is what a step gives that
// is shortened to end there.
#pragma once

#include <utility>
#include <vector>

#include "simbody_bridge/island_engine.h"

namespace tcs {

// `Base` is a kind of IslandEngine, and constructed from `arguments`.
template <class Base>
class SetStepEngine : public Base {
 public:
  template <class... Arguments>
  explicit SetStepEngine(VirtualDuration step, Arguments&&... arguments)
      : Base(std::forward<Arguments>(arguments)...), step_(step) {}

  VirtualDuration LongestStep(int /*island*/) const final { return step_; }
  bool has_set_steps() const final { return true; }
  void Take(IslandStep& step) final {
    step.length_s = step.limit.seconds();
    Advance(step, step.length_s, &step.to);
  }
  void Within(const IslandStep& step, VirtualDuration after, std::vector<double>* state) final {
    Advance(step, after.seconds(), state);
  }

 private:
  // From the step's beginning, so far.
  virtual void Advance(const IslandStep& step, double seconds, std::vector<double>* to) = 0;

  const VirtualDuration step_;
};

}  // namespace tcs
