#include <deque>

#include "simbody_bridge/model_loads.h"
#include "simbody_bridge/mujoco/mujoco_engine.h"
#include "simbody_bridge/mujoco/mujoco_system.h"

namespace tcs {
namespace {

class MujocoModels : public ModelEngine {
 public:
  MujocoModels(const WorldSpec& world, const std::vector<std::vector<int>>& islands)
      : models_(world.models),
        fixtures_(world.fixtures),
        step_(world.integrator.fixed_step > VirtualDuration{} ? world.integrator.fixed_step
                                                              : kMujocoStep),
        loads_(models_, islands) {
    for (const std::vector<int>& models : islands) {
      forests_.push_back(MakeForest(models_, models, fixtures_));
      systems_.emplace_back(forests_.back(), world.gravity_mps2);
    }
  }

  IslandStart StartOf(int island) override { return {At(island).start(), 0}; }
  VirtualDuration LongestStep(int /*island*/) const override { return step_; }
  bool has_set_steps() const override { return true; }

  void Take(IslandStep& step) override {
    step.length_s = step.limit.seconds();
    At(step.island).Step(step.from, loads_.MeanOver(step, step.length_s), step.length_s, &step.to);
  }
  // What a step gives that is shortened to end there.
  void Within(const IslandStep& step, VirtualDuration after, std::vector<double>* state) override {
    const double after_s = after.seconds();
    At(step.island).Step(step.from, loads_.MeanOver(step, after_s), after_s, state);
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
  MujocoSystem& At(int island) { return systems_[static_cast<std::size_t>(island)]; }

  const std::vector<RobotModel> models_;  // which the forests point into, as into the fixtures
  const std::vector<Shape> fixtures_;
  const VirtualDuration step_;
  ModelLoads loads_;
  std::deque<Forest> forests_;
  std::deque<MujocoSystem> systems_;
};

}  // namespace

std::unique_ptr<ModelEngine> MakeMujocoModels(const WorldSpec& world,
                                              const std::vector<std::vector<int>>& islands) {
  return std::make_unique<MujocoModels>(world, islands);
}

}  // namespace tcs
