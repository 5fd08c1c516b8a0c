// What acts on a model that a bare engine integrates, by place (model_engine.h), as the commands
// after a sample say.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "simbody_bridge/model_engine.h"
#include "simbody_bridge/model_loads.h"
#include "tests/bench/model_work.h"

namespace tcs::bench {

class BareLoads {
 public:
  explicit BareLoads(const ModelWork& work) : work_(work), loads_(work.world.models, kTheModel) {
    const RobotModel& model = work.model();
    step_.wrenches.resize(2 * model.links.size() + model.joints.size() + model.rotors.size());
  }

  // Valid until the next call.
  std::span<const Wrench> After(int sample) {
    const RobotModel& model = work_.model();
    const int links = static_cast<int>(model.links.size());
    const int joints = static_cast<int>(model.joints.size());
    if (work_.speeds_radps != nullptr) {
      const std::vector<double> speeds = work_.speeds_radps(sample, model);
      for (std::size_t i = 0; i < speeds.size(); ++i) {
        At(PlaceOfRotor(links, joints, static_cast<int>(i))) = AsNumbers(speeds[i], {});
      }
    }
    if (work_.drives != nullptr) {
      const std::vector<JointDrive> drives = work_.drives(sample, model);
      for (int joint = 0, next = 0; joint < joints; ++joint) {
        if (model.joints[static_cast<std::size_t>(joint)].kind == JointKind::kFixed) continue;
        At(PlaceOfJoint(links, joint)) = AsNumbers(drives[static_cast<std::size_t>(next++)]);
      }
    }
    return loads_.At(step_, 0);
  }

  static constexpr std::array<int, 1> kTheModel{0};

 private:
  Wrench& At(int place) { return step_.wrenches[static_cast<std::size_t>(place)]; }

  const ModelWork& work_;
  ModelLoads loads_;
  IslandStep step_;
};

}  // namespace tcs::bench
