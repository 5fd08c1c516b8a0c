#include "simbody_bridge/simbody/tree/tree_steps.h"

#include "simbody_bridge/simbody/kutta.h"

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

double TreeSteps::ErrorOf(const SimbodyTree& tree, const IslandStep& step, double h) {
  const auto slots = tree.slots();
  return KuttaError(
      step, middle_rate_, h, slots.size(), [&](std::size_t joint) { return slots[joint]; },
      &worst_body_);
}

}  // namespace tcs
