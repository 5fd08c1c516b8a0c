// A step of an island of models, whatever the method: as long as error control lets it be, or
// whole.
#pragma once

#include <algorithm>

#include "simbody_bridge/island_engine.h"
#include "simbody_bridge/model_loads.h"
#include "simbody_bridge/simbody/kutta.h"
#include "simbody_bridge/simbody/tree/tree.h"
#include "simbody_bridge/simbody/tree/whole_nanoseconds.h"

namespace tcs {

// `Method` derives from it, writes `worst_body_` of what it has tried, and has
//   Begin(tree, loads, step): what any length of the step needs
//   Try(tree, loads, step, seconds): a step of that length
//   ErrorOf(tree, step, seconds): how far that may be off (GreatestError)
//   EndAtEvent(tree, loads, step): of one that is good enough, to end it earlier
//   FirstKink(tree, loads, step, seconds): of one that is not, when what acts has its first kink;
//     else its length
template <class Method>
class ControlledSteps {
 public:
  // No longer than `limit_s`, which is within the step's. `accuracy` as of RungeKutta3, over a
  // joint's coordinates or speeds. Throws std::runtime_error where no step is short enough for it.
  void TakeControlled(SimbodyTree& tree, ModelLoads& loads, IslandStep& step, double accuracy,
                      double limit_s) {
    method().Begin(tree, loads, step);
    StepLength length(step,
                      std::min(limit_s, std::max(kShortestStepS, tree.LongestStepFrom(step.from))));
    if (length.seconds() != step.limit.seconds()) length.Set(WholeNanoseconds(length.seconds()));
    while (!IsGoodEnough(tree, loads, step, accuracy, &length)) {
      length.Set(WholeNanoseconds(length.seconds()));
    }
    method().EndAtEvent(tree, loads, step);
    tree.Project(step.to);
    step.to_rate.resize(step.to.size());
    tree.EvaluateOrRecall(step.to, loads.At(step, step.length_s), step.to_rate.data());
  }

  // The body whose error was the greatest in what was tried last.
  std::size_t worst_body() const { return worst_body_; }

  // As long as its limit.
  void TakeWhole(SimbodyTree& tree, ModelLoads& loads, IslandStep& step) {
    method().Begin(tree, loads, step);
    step.length_s = step.limit.seconds();
    method().Try(tree, loads, step, step.length_s);
    tree.Project(step.to);
  }

 protected:
  std::size_t worst_body_ = 0;

 private:
  // A kink in the last thousandth of a step is not what made it fail.
  static constexpr double kShorter = 0.999;

  Method& method() { return static_cast<Method&>(*this); }

  bool IsGoodEnough(SimbodyTree& tree, ModelLoads& loads, IslandStep& step, double accuracy,
                    StepLength* length) {
    const double seconds = length->seconds();
    method().Try(tree, loads, step, seconds);
    if (length->Judge(method().ErrorOf(tree, step, seconds), accuracy, &step)) return true;
    // A try that has gone astray has kinks anywhere: error control goes as far by itself.
    const double kink_s = method().FirstKink(tree, loads, step, seconds);
    if (kink_s > length->seconds() && kink_s < kShorter * seconds) length->Set(kink_s);
    return false;
  }
};

}  // namespace tcs
