#include <deque>

#include "simbody_bridge/mujoco/mujoco_engine.h"
#include "simbody_bridge/mujoco/mujoco_system.h"
#include "simbody_bridge/set_steps.h"

namespace tcs {
namespace {

class MujocoModels : public SetStepEngine<ModelEngine> {
 public:
  MujocoModels(const WorldSpec& world, const std::vector<std::vector<int>>& islands)
      : SetStepEngine(world.integrator.StepOr(kMujocoStep)),
        models_(world.models),
        fixtures_(world.fixtures) {
    for (const std::vector<int>& models : islands) {
      forests_.push_back(MakeForest(models_, models, fixtures_));
      systems_.emplace_back(forests_.back(), world.gravity_mps2);
    }
  }

  IslandStart StartOf(int island) override { return {At(island).start(), 0}; }

  void ReadLinks(int island, std::span<const double> state, std::span<const int> links,
                 std::span<LinkState> read) override {
    At(island).ReadLinks(state, links, read);
  }
  void ReadJoints(int island, std::span<const double> state, std::span<const Wrench> acting,
                  std::span<const int> joints, std::span<JointState> read) override {
    At(island).ReadJoints(state, acting, joints, read);
  }

 private:
  void Advance(const IslandStep& step, double seconds, std::vector<double>* to) override {
    At(step.island).Step(step.from, step.wrenches, seconds, to);
  }
  MujocoSystem& At(int island) { return systems_[static_cast<std::size_t>(island)]; }

  const std::vector<RobotModel> models_;  // which the forests point into, as into the fixtures
  const std::vector<Shape> fixtures_;
  std::deque<Forest> forests_;
  std::deque<MujocoSystem> systems_;
};

}  // namespace

std::unique_ptr<ModelEngine> MakeMujocoModels(const WorldSpec& world,
                                              const std::vector<std::vector<int>>& islands) {
  return std::make_unique<MujocoModels>(world, islands);
}

}  // namespace tcs
