// Instead of MuJoCo, in a build that has not found it.
#include "simbody_bridge/mujoco/mujoco_engine.h"

namespace tcs {
namespace {

[[noreturn]] void Refuse() {
  throw DynamicsError(
      "engine: this tcs was built without MuJoCo; install Debian's libmujoco-dev and build it "
      "again, or take simbody");
}

}  // namespace

std::unique_ptr<ModelEngine> MakeMujocoModels(const WorldSpec& /*world*/,
                                              const std::vector<std::vector<int>>& /*islands*/) {
  Refuse();
}
std::unique_ptr<BodyEngine> MakeMujocoBodies(const WorldSpec& /*world*/,
                                             const std::vector<std::vector<int>>& /*islands*/) {
  Refuse();
}

}  // namespace tcs
