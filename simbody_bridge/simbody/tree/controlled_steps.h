// A step of an island of models, whatever the method: as long as error control lets it be, or
// whole.
#pragma once

#include <algorithm>

#include "simbody_bridge/island_engine.h"
#include "simbody_bridge/model_loads.h"
#include "simbody_bridge/simbody/kutta.h"
#include "simbody_bridge/simbody/tree/tree.h"
#include "simbody_bridge/whole_nanoseconds.h"

namespace tcs {

// `Method` derives from this class, writes `worst_body_` of what it has tried, and has
//   Begin(tree, loads, step): finds what any length of the step needs
//   Try(tree, loads, step, seconds): tries a step of that length
//   ErrorOf(tree, step, seconds): how far that step may be off (GreatestError)
//   EndAtEvent(tree, loads, step): ends a step that is good enough earlier, at an event
//   PredictKink(tree, loads, step, seconds): before any try, when the acting loads have their first
//     kink, as far as that can be told; else that length
//   LateKink(tree, loads, step, seconds): when that kink comes, of a good try that was to end
//     behind it and does not; else the try's length
//   FirstKink(tree, loads, step, seconds): when the first kink was, of a try that is not good
//     enough; else the try's length
template <class Method>
class ControlledSteps {
 public:
  // Takes a step no longer than `limit_s`, which is within the step's limit. `accuracy` as of
  // RungeKutta3, over a joint's coordinates or speeds. Throws std::runtime_error where no step is
  // short enough for the accuracy.
  void TakeControlled(SimbodyTree& tree, ModelLoads& loads, IslandStep& step, double accuracy,
                      double limit_s) {
    method().Begin(tree, loads, step);
    StepLength length(step,
                      std::min(limit_s, std::max(kShortestStepS, tree.LongestStepFrom(step.from))));
    if (length.seconds() != step.limit.seconds()) length.Set(WholeNanoseconds(length.seconds()));
    const double most_s = length.seconds();
    const double kink_s = method().PredictKink(tree, loads, step, most_s);
    if (kink_s < most_s) length.Cut(kink_s);
    TryUntilGoodEnough(tree, loads, step, accuracy, &length);
    if (kink_s < most_s) GoOnToKink(tree, loads, step, accuracy, most_s, &length);
    method().EndAtEvent(tree, loads, step);
    tree.Project(step.to);
    step.to_rate.resize(step.to.size());
    tree.EvaluateOrRecall(step.to, loads.At(step, step.length_s), step.to_rate.data());
  }

  // The body whose error was the greatest in the last try.
  std::size_t worst_body() const { return worst_body_; }

  // Takes a step as long as its limit.
  void TakeWhole(SimbodyTree& tree, ModelLoads& loads, IslandStep& step) {
    method().Begin(tree, loads, step);
    step.length_s = step.limit.seconds();
    method().Try(tree, loads, step, step.length_s);
    tree.Project(step.to);
  }

 protected:
  std::size_t worst_body_ = 0;

 private:
  // A step as brief as this is not tried once more to make it longer.
  static constexpr double kBriefS = 1e-8;

  Method& method() { return static_cast<Method&>(*this); }

  void TryUntilGoodEnough(SimbodyTree& tree, ModelLoads& loads, IslandStep& step, double accuracy,
                          StepLength* length) {
    for (;;) {
      const double seconds = length->seconds();
      method().Try(tree, loads, step, seconds);
      if (length->Judge(method().ErrorOf(tree, step, seconds), accuracy, &step)) return;
      // A try that has gone astray has kinks anywhere: error control goes as far by itself.
      const double kink_s = method().FirstKink(tree, loads, step, seconds);
      if (kink_s > length->seconds() && kink_s < seconds) length->Cut(kink_s);
      length->Set(WholeNanoseconds(length->seconds()));
    }
  }

  // Where the kink comes later than was predicted, the step is tried once more: else small steps
  // would come ever nearer to it.
  void GoOnToKink(SimbodyTree& tree, ModelLoads& loads, IslandStep& step, double accuracy,
                  double most_s, StepLength* length) {
    const double reached_s = step.length_s;
    const double late_s = method().LateKink(tree, loads, step, reached_s);
    if (late_s <= reached_s || late_s >= most_s || reached_s < kBriefS) return;
    length->Cut(late_s);
    TryUntilGoodEnough(tree, loads, step, accuracy, length);
  }
};

}  // namespace tcs
