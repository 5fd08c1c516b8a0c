#include "simbody_bridge/simbody/tree/tree_steps.h"

#include "simbody_bridge/simbody/kutta.h"
#include "simbody_bridge/simbody/tree/try_lengths.h"

namespace tcs {

void TreeSteps::Begin(SimbodyTree& tree, ModelLoads& loads, IslandStep& step) {
  const std::size_t size = step.from.size();
  step.to.resize(size);
  step.from_rate.resize(size);
  step.course.clear();
  state_.resize(size);
  middle_rate_.resize(size);
  end_rate_.resize(size);
  tree.EvaluateOrRecall(step.from, loads.At(step, 0), step.from_rate.data());
}

void TreeSteps::Try(SimbodyTree& tree, ModelLoads& loads, IslandStep& step, double h) {
  KuttaMiddle(step, h, &state_);
  tree.Evaluate(state_, loads.At(step, h / 2), middle_rate_.data());
  KuttaEnd(step, middle_rate_, h, &state_);
  tree.Evaluate(state_, loads.At(step, h), end_rate_.data());
  KuttaStep(middle_rate_, end_rate_, h, &step);
}

double TreeSteps::ErrorOf(const SimbodyTree& tree, const IslandStep& step, double h) const {
  const auto slots = tree.slots();
  return KuttaError(step, middle_rate_, h, slots.size(),
                    [&](std::size_t joint) { return slots[joint]; });
}

void TreeSteps::TakeControlled(SimbodyTree& tree, ModelLoads& loads, IslandStep& step,
                               double accuracy, double limit_s) {
  Begin(tree, loads, step);
  TryLengths(tree, accuracy, limit_s, &step, [&](double h) {
    Try(tree, loads, step, h);
    return ErrorOf(tree, step, h);
  });
  tree.Project(step.to);
  step.to_rate.resize(step.to.size());
  tree.EvaluateOrRecall(step.to, loads.At(step, step.length_s), step.to_rate.data());
}

void TreeSteps::TakeWhole(SimbodyTree& tree, ModelLoads& loads, IslandStep& step) {
  Begin(tree, loads, step);
  step.length_s = step.limit.seconds();
  Try(tree, loads, step, step.length_s);
  tree.Project(step.to);
}

}  // namespace tcs
