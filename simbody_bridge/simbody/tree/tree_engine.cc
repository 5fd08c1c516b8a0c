#include "simbody_bridge/simbody/tree/tree_engine.h"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "simbody_bridge/forest_engine.h"
#include "simbody_bridge/simbody/steps.h"
#include "simbody_bridge/simbody/tree/contact_step.h"
#include "simbody_bridge/simbody/tree/joint_steps.h"
#include "simbody_bridge/simbody/tree/tree_steps.h"

namespace tcs {
namespace {

constexpr double kFirstTreeTryS = 1e-3;
// The step where something touches, or is about to.
constexpr VirtualDuration kContactStep = VirtualDuration::Milliseconds(1);

// A tree with the memory of its steps: islands are integrated side by side.
struct SteppedTree : SimbodyTree {
  SteppedTree(const Forest& forest, const std::array<double, 3>& gravity_mps2) try
      : SimbodyTree(forest, gravity_mps2) {
  } catch (const std::exception& e) {
    throw DynamicsError(std::string("Simbody refuses it: ") + e.what());
  }

  // Takes a step in which nothing touches.
  void TakeControlled(ModelLoads& loads, IslandStep& step, double accuracy, double limit_s) {
    const JointSteps::Fit fit = joint_steps.FitOf(*this, loads.At(step, 0));
    took_joints = fit == JointSteps::Fit::kFits;
    switch (fit) {
      case JointSteps::Fit::kNotNeeded:
        steps.TakeControlled(*this, loads, step, accuracy, limit_s);
        return;
      case JointSteps::Fit::kFits:
        joint_steps.TakeControlled(*this, loads, step, accuracy, limit_s);
        return;
      case JointSteps::Fit::kTooLarge:
        TakeShort(loads, step, std::min(std::min(kContactStep, step.limit).seconds(), limit_s));
        return;
    }
  }
  void TakeWhole(ModelLoads& loads, IslandStep& step) {
    switch (joint_steps.FitOf(*this, loads.At(step, 0))) {
      case JointSteps::Fit::kNotNeeded:
        steps.TakeWhole(*this, loads, step);
        return;
      case JointSteps::Fit::kFits:
        joint_steps.TakeWhole(*this, loads, step);
        return;
      case JointSteps::Fit::kTooLarge:
        contact_step.Take(*this, loads, step, step.limit.seconds());
        return;
    }
  }

  std::size_t worst_body() const {
    return took_joints ? joint_steps.worst_body() : steps.worst_body();
  }

  void TakeShort(ModelLoads& loads, IslandStep& step, double length_s) {
    if (length_s < step.limit.seconds()) length_s = WholeNanoseconds(length_s);
    contact_step.Take(*this, loads, step, length_s);
  }

  TreeSteps steps;
  JointSteps joint_steps;
  ContactStep contact_step;
  bool took_joints = false;
  IslandStep shortened;
};

class TreeEngine : public ForestEngine<SteppedTree> {
 public:
  TreeEngine(const WorldSpec& world, const std::vector<std::vector<int>>& islands)
      : ForestEngine(world, islands),
        has_set_steps_(world.integrator.fixed_step > VirtualDuration{}),
        longest_step_(world.integrator.StepOr(kLongestStep)),
        accuracy_(world.integrator.accuracy) {}

  IslandStart StartOf(int island) override { return {At(island).start(), kFirstTreeTryS}; }
  VirtualDuration LongestStep(int /*island*/) const override { return longest_step_; }
  bool has_set_steps() const override { return has_set_steps_; }

  std::string SuspectOf(int island) override { return NameOfBody(island, At(island).worst_body()); }

  // Simbody's own words name its source lines.
  void Take(IslandStep& step) override {
    try {
      TakeStep(step);
    } catch (const SimTK::Exception::Base&) {
      throw std::runtime_error("numbers become too large or too small for Simbody");
    }
  }

  void TakeStep(IslandStep& step) {
    SteppedTree& tree = At(step.island);
    ModelLoads& loads = LoadsOn(step.island);
    const double free_s = tree.TimeToTouch(step.from);
    if (const double contact_s = ContactStepOf(step).seconds(); free_s < contact_s) {
      TakeInContact(tree, loads, step, contact_s);
    } else if (has_set_steps_) {
      tree.TakeWhole(loads, step);
    } else {
      tree.TakeControlled(loads, step, accuracy_, std::min(step.limit.seconds(), free_s));
      // A body was pushed harder than is trusted.
      while (step.length_s > kContactStep.seconds() &&
             tree.MayHaveTouched(step.to, step.length_s)) {
        tree.TakeControlled(loads, step, accuracy_, step.length_s / 2);
      }
    }
  }

  void Within(const IslandStep& step, VirtualDuration after, std::vector<double>* state) override {
    if (has_set_steps_) {
      TakeShortened(*this, step, after, &At(step.island).shortened, state);
      return;
    }
    SteppedTree& tree = At(step.island);
    if (JointSteps::Took(step)) {
      tree.joint_steps.Within(tree, step, after.seconds(), state);
    } else {
      InterpolateNumbers(step, after.seconds(), state);
    }
    tree.NormaliseQuaternions(*state);
  }

  void ReadContacts(const IslandStep& step, VirtualDuration after,
                    std::vector<ContactForce>* contacts) override {
    SteppedTree& tree = At(step.island);
    IslandStep again = step;
    if (has_set_steps_) again.limit = after;
    const double contact_s = ContactStepOf(again).seconds();
    if (tree.TimeToTouch(again.from) >= contact_s) return;
    TakeInContact(tree, LoadsOn(step.island), again, contact_s);
    std::vector<ShapeContact> found;
    tree.contact_step.ReadForces(&found);
    AppendForces(ForestOf(step.island), found, contacts);
  }

 private:
  void TakeInContact(SteppedTree& tree, ModelLoads& loads, IslandStep& step, double length_s) {
    if (has_set_steps_) {
      tree.contact_step.Take(tree, loads, step, length_s);
    } else {
      tree.contact_step.TakeUpToTouch(tree, loads, step, length_s);
    }
  }
  // The length of a step of contact.
  VirtualDuration ContactStepOf(const IslandStep& step) const {
    return has_set_steps_ ? step.limit : std::min(kContactStep, step.limit);
  }

  const bool has_set_steps_;
  const VirtualDuration longest_step_;
  const double accuracy_;
};

}  // namespace

std::unique_ptr<ModelEngine> MakeTreeEngine(const WorldSpec& world,
                                            const std::vector<std::vector<int>>& islands) {
  if (world.integrator.kind != IntegratorKind::kRungeKutta3) {
    throw DynamicsError(
        "models move on Simbody by the integrator runge_kutta3 only; leave `integrator` out, or "
        "take MuJoCo as the engine");
  }
  return std::make_unique<TreeEngine>(world, islands);
}

}  // namespace tcs
