// The links, joints and rotors of all models, numbered through: the first model's in its own order,
// then the next model's. Pure.
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include "simbody_bridge/model/robot_model.h"

namespace tcs {

// A link, a joint or a rotor.
struct ModelPart {
  int model = 0;
  int index = 0;  // there
};

class ModelParts {
 public:
  explicit ModelParts(const std::vector<RobotModel>& models);

  // None: there is no such part.
  std::optional<int> FindLink(std::string_view model, std::string_view link) const;
  std::optional<int> FindJoint(std::string_view model, std::string_view joint) const;
  std::optional<int> FindRotor(std::string_view model, std::string_view rotor) const;
  // The part with a number, which has to exist.
  const ModelPart& LinkAt(int link) const { return At(links_, link); }
  const ModelPart& JointAt(int joint) const { return At(joints_, joint); }
  const ModelPart& RotorAt(int rotor) const { return At(rotors_, rotor); }

 private:
  static const ModelPart& At(const std::vector<ModelPart>& parts, int index);

  const std::vector<RobotModel>& models_;
  std::vector<ModelPart> links_, joints_, rotors_;
  std::vector<std::size_t> first_link_, first_joint_, first_rotor_;  // of each model
};

}  // namespace tcs
