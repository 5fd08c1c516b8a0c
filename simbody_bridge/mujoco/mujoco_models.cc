#include "simbody_bridge/contact_forces.h"
#include "simbody_bridge/forest_engine.h"
#include "simbody_bridge/mujoco/mujoco_engine.h"
#include "simbody_bridge/mujoco/mujoco_system.h"
#include "simbody_bridge/set_steps.h"

namespace tcs {
namespace {

class MujocoModels : public SetStepEngine<ForestEngine<MujocoSystem>> {
 public:
  MujocoModels(const WorldSpec& world, const std::vector<std::vector<int>>& islands)
      : SetStepEngine(world.integrator.StepOr(kMujocoStep), world, islands) {}

  std::string SuspectOf(int island) override {
    const int body = At(island).failed_body();
    return body < 0 ? std::string() : NameOfBody(island, static_cast<std::size_t>(body));
  }

  IslandStart StartOf(int island) override { return {At(island).start(), 0}; }

  void ReadContacts(const IslandStep& step, VirtualDuration after,
                    std::vector<ContactForce>* contacts) override {
    if (ForestOf(step.island).shapes.size() < 2) return;
    std::vector<ShapeContact> found;
    const double seconds = after.seconds();
    At(step.island)
        .FindForces(step.from, LoadsOn(step.island).MeanOver(step, seconds), seconds, &found);
    AppendForces(ForestOf(step.island), found, contacts);
  }

 private:
  void Advance(const IslandStep& step, double seconds, std::vector<double>* to) override {
    At(step.island).Step(step.from, LoadsOn(step.island).MeanOver(step, seconds), seconds, to);
  }
};

}  // namespace

std::unique_ptr<ModelEngine> MakeMujocoModels(const WorldSpec& world,
                                              const std::vector<std::vector<int>>& islands) {
  return std::make_unique<MujocoModels>(world, islands);
}

}  // namespace tcs
