#include "simbody_bridge/model_parts.h"

#include "simbody_bridge/require.h"

namespace tcs {
namespace {

template <class Part>
std::optional<int> Find(const std::vector<RobotModel>& models,
                        const std::vector<std::size_t>& firsts,
                        std::vector<Part> RobotModel::*parts, std::string_view model,
                        std::string_view name) {
  for (std::size_t i = 0; i < models.size(); ++i) {
    if (models[i].name != model) continue;
    const std::vector<Part>& all = models[i].*parts;
    for (std::size_t k = 0; k < all.size(); ++k) {
      if (all[k].name == name) return static_cast<int>(firsts[i] + k);
    }
  }
  return {};
}

}  // namespace

ModelParts::ModelParts(const std::vector<RobotModel>& models) : models_(models) {
  for (std::size_t i = 0; i < models.size(); ++i) {
    const int model = static_cast<int>(i);
    first_link_.push_back(links_.size());
    first_joint_.push_back(joints_.size());
    first_rotor_.push_back(rotors_.size());
    for (std::size_t k = 0; k < models[i].links.size(); ++k) {
      links_.push_back({model, static_cast<int>(k)});
    }
    for (std::size_t k = 0; k < models[i].joints.size(); ++k) {
      joints_.push_back({model, static_cast<int>(k)});
    }
    for (std::size_t k = 0; k < models[i].rotors.size(); ++k) {
      rotors_.push_back({model, static_cast<int>(k)});
    }
  }
}

std::optional<int> ModelParts::FindLink(std::string_view model, std::string_view link) const {
  return Find(models_, first_link_, &RobotModel::links, model, link);
}

std::optional<int> ModelParts::FindJoint(std::string_view model, std::string_view joint) const {
  return Find(models_, first_joint_, &RobotModel::joints, model, joint);
}

std::optional<int> ModelParts::FindRotor(std::string_view model, std::string_view rotor) const {
  return Find(models_, first_rotor_, &RobotModel::rotors, model, rotor);
}

const ModelPart& ModelParts::At(const std::vector<ModelPart>& parts, int index) {
  Require(index >= 0 && index < static_cast<int>(parts.size()), "no such link, joint or rotor");
  return parts[static_cast<std::size_t>(index)];
}

}  // namespace tcs
