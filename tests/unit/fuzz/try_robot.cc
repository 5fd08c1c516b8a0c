#include "tests/unit/fuzz/try_robot.h"

#include <algorithm>
#include <cmath>
#include <variant>
#include <vector>

#include "coordinator/errors/visible.h"
#include "coordinator/models/load_urdf.h"
#include "simbody_bridge/engines.h"
#include "simbody_bridge/model/model_check.h"

namespace tcs::fuzz {
namespace {

bool IsOneSentence(const std::string& sentence) {
  return !sentence.empty() && sentence.size() < 10'000 && sentence.find('\n') == std::string::npos;
}

// Its motion on each engine, which may refuse it, too.
std::string Move(const RobotModel& model, VirtualDuration moved, bool* refused) {
  for (const EngineTraits& engine : kEngines) {
    if (!engine.has_models) continue;
    WorldSpec world;
    world.gravity_mps2 = {0, 0, -9.81};
    world.integrator.engine = engine.kind;
    world.models = {model};
    world.fixtures = {{.geometry = PlaneShape{}}};
    try {
      auto dynamics = MakeDynamics(world);
      const VirtualTime end = VirtualTime{} + moved;
      for (int link = 0; link < static_cast<int>(model.links.size()); ++link) {
        LinkState state;
        dynamics->ReadLinks(end, {&link, 1}, {&state, 1});
        if (!std::isfinite(state.pose.position_m[2])) return "a link is nowhere";
      }
    } catch (const DynamicsError& error) {
      *refused = true;
      if (!IsOneSentence(error.what())) return "an engine says: " + Visible(error.what());
    }
  }
  return {};
}

}  // namespace

std::string TryRobot(const std::string& urdf, const std::string& damaged, VirtualDuration moved,
                     bool* refused) {
  MeshLibrary meshes;
  UrdfRemarks remarks;
  const auto loaded = LoadUrdf(urdf, {}, PackagePath({TCS_MODEL_ZOO}), &meshes, &remarks);
  for (const std::string& warning : remarks.warnings) {
    if (!IsOneSentence(warning)) return "a warning is: " + Visible(warning);
  }
  const auto* errors = std::get_if<std::vector<LoadError>>(&loaded);
  *refused = errors != nullptr;
  if (errors != nullptr) {
    if (errors->empty()) return "a refusal says nothing";
    for (const auto& [message] : *errors) {
      const bool is_placed = message.starts_with(urdf + ":") || message.starts_with(damaged + ":");
      if (!is_placed || !IsOneSentence(message)) {
        return "a refusal does not say where: " + Visible(message);
      }
    }
    return {};
  }
  RobotModel model = std::get<LoadedUrdf>(loaded).model;
  // Where its joints start is not in the file.
  for (Joint& joint : model.joints) {
    if (joint.mimic || CoordinatesOf(joint.kind) != 1) continue;
    joint.initial_position = {std::clamp(0.0, joint.limits.lower, joint.limits.upper)};
  }
  if (const auto fault = CheckModel(model)) return "it is no model: " + Visible(fault->what);
  constexpr std::size_t kMostLinks = 60;
  return model.links.size() > kMostLinks ? "" : Move(model, moved, refused);
}

}  // namespace tcs::fuzz
