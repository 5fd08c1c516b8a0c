#include "simbody_bridge/simbody/tree/tree_engine.h"

#include <algorithm>

#include "simbody_bridge/forest_engine.h"
#include "simbody_bridge/one_line.h"
#include "simbody_bridge/simbody/steps.h"
#include "simbody_bridge/simbody/tree/contact_step.h"
#include "simbody_bridge/simbody/tree/tree_steps.h"

namespace tcs {
namespace {

constexpr double kFirstTryS = 1e-3;
// Where something touches, or is about to.
constexpr VirtualDuration kContactStep = VirtualDuration::Milliseconds(1);

class TreeEngine : public ForestEngine<SimbodyTree> {
 public:
  TreeEngine(const WorldSpec& world, const std::vector<std::vector<int>>& islands)
      : ForestEngine(world, islands),
        has_set_steps_(world.integrator.fixed_step > VirtualDuration{}),
        longest_step_(world.integrator.StepOr(kLongestStep)),
        steps_(world.integrator.accuracy) {}

  IslandStart StartOf(int island) override { return {At(island).start(), kFirstTryS}; }
  VirtualDuration LongestStep(int /*island*/) const override { return longest_step_; }
  bool has_set_steps() const override { return has_set_steps_; }

  void Take(IslandStep& step) override {
    SimbodyTree& tree = At(step.island);
    ModelLoads& loads = LoadsOn(step.island);
    const double limit_s = step.limit.seconds();
    const double free_s = tree.TimeToTouch(step.from);
    if (has_set_steps_) {
      if (free_s < limit_s) {
        contact_step_.Take(tree, loads, step, limit_s);
      } else {
        steps_.TakeWhole(tree, loads, step);
      }
    } else if (free_s < std::min(kContactStep, step.limit).seconds()) {
      contact_step_.Take(tree, loads, step, std::min(kContactStep, step.limit).seconds());
    } else {
      steps_.TakeControlled(tree, loads, step, std::min(limit_s, free_s));
      // It was pushed harder than is trusted.
      while (step.length_s > kContactStep.seconds() &&
             tree.MayHaveTouched(step.to, step.length_s)) {
        steps_.TakeControlled(tree, loads, step, step.length_s / 2);
      }
    }
  }

  void Within(const IslandStep& step, VirtualDuration after, std::vector<double>* state) override {
    if (has_set_steps_) {
      TakeShortened(*this, step, after, &shortened_, state);
      return;
    }
    InterpolateNumbers(step, after.seconds(), state);
    At(step.island).NormaliseQuaternions(*state);
  }

 private:
  const bool has_set_steps_;
  const VirtualDuration longest_step_;
  TreeSteps steps_;
  ContactStep contact_step_;
  IslandStep shortened_;  // memory of Within
};

}  // namespace

std::unique_ptr<ModelEngine> MakeTreeEngine(const WorldSpec& world,
                                            const std::vector<std::vector<int>>& islands) {
  if (world.integrator.kind != IntegratorKind::kRungeKutta3) {
    throw DynamicsError(
        "models move on Simbody by the integrator runge_kutta3 only; leave `integrator` out, or "
        "take MuJoCo as the engine");
  }
  try {
    return std::make_unique<TreeEngine>(world, islands);
  } catch (const std::exception& e) {
    throw DynamicsError("Simbody refuses the models: " + OnOneLine(e.what()));
  }
}

}  // namespace tcs
