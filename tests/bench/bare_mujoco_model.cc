// The one program beside simbody_bridge/ that includes MuJoCo.
#include <fmt/format.h>
#include <mujoco/mujoco.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <memory>

#include "shm/check.h"
#include "simbody_bridge/load.h"
#include "simbody_bridge/model/vectors.h"
#include "simbody_bridge/mujoco/mjcf.h"
#include "tests/bench/bare_model.h"
#include "tests/bench/physics_world.h"

namespace tcs::bench {

namespace {

mjModel* Compile(const std::string& mjcf) {
  constexpr const char* kName = "bare.xml";
  const auto files = std::make_unique<mjVFS>();
  mj_defaultVFS(files.get());
  TCS_CHECK(mj_makeEmptyFileVFS(files.get(), kName, static_cast<int>(mjcf.size())) == 0);
  std::memcpy(files->filedata[0], mjcf.data(), mjcf.size());
  std::array<char, 1000> error{};
  mjModel* model = mj_loadXML(kName, files.get(), error.data(), static_cast<int>(error.size()));
  mj_deleteFileVFS(files.get(), kName);
  TCS_CHECK(model != nullptr);
  return model;
}

// All that acts along a body's axes is of one actuator, whose gear it is.
void SetForces(const Forest& forest, std::span<const Wrench> acting, mjModel& model, mjData& data) {
  std::vector<Load> on_body(forest.bodies.size());
  for (std::size_t i = 0; i < forest.links.size(); ++i) {
    const TreeLink& link = forest.links[i];
    if (link.body == kWorldBody) continue;
    const Load load = LoadOf(WrenchOnLink(acting, i, WrenchFrame::kLink));
    const auto force = Rotate(link.pose.orientation_xyzw, load.force_n);
    Load& sum = on_body[static_cast<std::size_t>(link.body)];
    AddTo(&sum, {force, Cross(link.pose.position_m, force)}, 1);
    AddTo(&sum, {{}, Rotate(link.pose.orientation_xyzw, load.torque_nm)}, 1);
  }
  const auto actuator = [&model](char prefix, std::size_t i) {
    return mj_name2id(&model, mjOBJ_ACTUATOR, fmt::format("{}{}", prefix, i).c_str());
  };
  for (std::size_t i = 0; i < on_body.size(); ++i) {
    double* gear = model.actuator_gear + 6 * actuator('b', i);
    std::copy_n(on_body[i].force_n.begin(), 3, gear);
    std::copy_n(on_body[i].torque_nm.begin(), 3, gear + 3);
    data.ctrl[actuator('b', i)] = 1;
  }
  for (std::size_t i = 0; i < forest.joints.size(); ++i) {
    if (!IsDriven(forest, i)) continue;
    const int of = actuator('j', i);
    const JointDrive drive = DriveOfJoint(acting, forest.links.size(), i);
    data.ctrl[of] =
        drive.effort + drive.stiffness * drive.position + drive.damping * drive.velocity;
    model.actuator_biasprm[mjNBIAS * of + 1] = -drive.stiffness;
    model.actuator_biasprm[mjNBIAS * of + 2] = -drive.damping;
  }
}

}  // namespace

bool HasMujoco() { return true; }

double BareMujocoSeconds(const ModelWork& work) {
  const Forest forest = MakeForest(work.world.models, BareLoads::kTheModel, work.world.fixtures);
  const std::unique_ptr<mjModel, decltype(&mj_deleteModel)> model(
      Compile(MjcfOf(forest, work.world.gravity_mps2)), &mj_deleteModel);
  const std::unique_ptr<mjData, decltype(&mj_deleteData)> data(mj_makeData(model.get()),
                                                               &mj_deleteData);
  // A free base, which has its place from its coordinates.
  for (std::size_t i = 0; i < forest.bodies.size(); ++i) {
    if (!HasFreeJoint(forest.bodies[i])) continue;
    std::copy_n(forest.bodies[i].position.begin(), 3, data->qpos);
  }
  model->opt.timestep = kMujocoStep.seconds();
  const auto steps = static_cast<int>(work.period.ns() / kMujocoStep.ns());
  BareLoads loads(work);
  const double start_s = CpuSeconds();
  for (int sample = 1; sample <= work.samples; ++sample) {
    for (int step = 0; step < steps; ++step) mj_step(model.get(), data.get());
    SetForces(forest, loads.After(sample), *model, *data);
  }
  return CpuSeconds() - start_s;
}

}  // namespace tcs::bench
