#include "simbody_bridge/simbody/tree/tree_engine.h"

#include <algorithm>
#include <deque>

#include "simbody_bridge/simbody/steps.h"
#include "simbody_bridge/simbody/tree/contact_step.h"
#include "simbody_bridge/simbody/tree/tree_steps.h"

namespace tcs {
namespace {

constexpr double kFirstTryS = 1e-3;
// Where something touches, or is about to.
constexpr VirtualDuration kContactStep = VirtualDuration::Milliseconds(1);
constexpr VirtualDuration kLongestStep = VirtualDuration::Seconds(1000);

class TreeEngine : public ModelEngine {
 public:
  TreeEngine(const WorldSpec& world, const std::vector<std::vector<int>>& islands)
      : models_(world.models),
        fixtures_(world.fixtures),
        fixed_step_(world.integrator.fixed_step),
        loads_(models_, islands),
        steps_(world.integrator.accuracy, loads_),
        contact_step_(loads_) {
    for (const std::vector<int>& models : islands) {
      forests_.push_back(MakeForest(models_, models, fixtures_));
      trees_.emplace_back(forests_.back(), world.gravity_mps2);
    }
  }

  IslandStart StartOf(int island) override { return {At(island).start(), kFirstTryS}; }
  VirtualDuration LongestStep(int /*island*/) const override {
    return has_set_steps() ? fixed_step_ : kLongestStep;
  }
  bool has_set_steps() const override { return fixed_step_ > VirtualDuration{}; }

  void Take(IslandStep& step) override {
    SimbodyTree& tree = At(step.island);
    const double limit_s = step.limit.seconds();
    const double free_s = tree.TimeToTouch(step.from);
    if (has_set_steps()) {
      if (free_s < limit_s) {
        contact_step_.Take(tree, step, limit_s);
      } else {
        steps_.TakeWhole(tree, step);
      }
    } else if (free_s < std::min(kContactStep, step.limit).seconds()) {
      contact_step_.Take(tree, step, std::min(kContactStep, step.limit).seconds());
    } else {
      steps_.TakeControlled(tree, step, std::min(limit_s, free_s));
    }
  }

  void Within(const IslandStep& step, VirtualDuration after, std::vector<double>* state) override {
    if (!has_set_steps()) {
      InterpolateNumbers(step, after.seconds(), state);
      At(step.island).NormaliseQuaternions(*state);
      return;
    }
    shortened_ = step;
    shortened_.limit = after;
    Take(shortened_);
    *state = shortened_.to;
  }

  void ReadLinks(int island, std::span<const double> state, std::span<const int> links,
                 std::span<LinkState> read) override {
    At(island).ReadLinks(state, links, read);
  }
  void ReadJoints(int island, std::span<const double> state, std::span<const Wrench> acting,
                  std::span<const int> joints, std::span<JointState> read) override {
    At(island).ReadJoints(state, acting, joints, read);
  }

 private:
  SimbodyTree& At(int island) { return trees_[static_cast<std::size_t>(island)]; }

  const std::vector<RobotModel> models_;  // which the forests point into, as into the fixtures
  const std::vector<Shape> fixtures_;
  const VirtualDuration fixed_step_;
  ModelLoads loads_;
  TreeSteps steps_;
  ContactStep contact_step_;
  std::deque<Forest> forests_;
  std::deque<SimbodyTree> trees_;
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
