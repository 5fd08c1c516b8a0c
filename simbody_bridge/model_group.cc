#include "simbody_bridge/model_group.h"

#include <algorithm>

namespace tcs {

ModelGroup::ModelGroup(const std::vector<RobotModel>& all, std::vector<int> models, int island)
    : models_(std::move(models)), island_(island) {
  for (const int index : models_) {
    const RobotModel& model = all[static_cast<std::size_t>(index)];
    Part part{links_,         static_cast<int>(model.links.size()),
              joints_,        static_cast<int>(model.joints.size()),
              rotors_,        static_cast<int>(model.rotors.size()),
              shapes_.size(), 0};
    for (ShapeOnLink shape : MovingShapesOf(model)) {
      const int link = links_ + shape.link;
      if (shape_links_.empty() || shape_links_.back() != link) shape_links_.push_back(link);
      shape.link = static_cast<int>(shape_links_.size()) - 1;
      shapes_.push_back(shape);
    }
    part.shapes = shapes_.size() - part.first_shape;
    links_ += part.links;
    joints_ += part.joints;
    rotors_ += part.rotors;
    parts_.push_back(part);
  }
  states_.resize(shape_links_.size());
  balls_.resize(shapes_.size());
}

std::size_t ModelGroup::MemberOf(int model) const {
  return static_cast<std::size_t>(std::lower_bound(models_.begin(), models_.end(), model) -
                                  models_.begin());
}

int ModelGroup::PlaceIn(std::size_t member, int place) const {
  const Part& part = parts_[member];
  const int joint = place - PlaceOfJoint(part.links, 0);
  if (joint < 0) return PlaceOfJoint(part.first_link, 0) + place;
  const int rotor = joint - part.joints;
  if (rotor < 0) return PlaceOfJoint(links_, part.first_joint + joint);
  return PlaceOfRotor(links_, joints_, part.first_rotor + rotor);
}

std::pair<std::size_t, int> ModelGroup::Locate(int place) const {
  const int joint = place - PlaceOfJoint(links_, 0), rotor = joint - joints_;
  std::size_t member = 0;
  if (joint < 0) {
    while (place >= PlaceOfJoint(parts_[member].first_link + parts_[member].links, 0)) ++member;
    return {member, place - PlaceOfJoint(parts_[member].first_link, 0)};
  }
  if (rotor < 0) {
    while (joint >= parts_[member].first_joint + parts_[member].joints) ++member;
    return {member, PlaceOfJoint(parts_[member].links, joint - parts_[member].first_joint)};
  }
  while (rotor >= parts_[member].first_rotor + parts_[member].rotors) ++member;
  const Part& part = parts_[member];
  return {member, PlaceOfRotor(part.links, part.joints, rotor - part.first_rotor)};
}

void ModelGroup::FindBalls(ModelEngine& engine, std::span<const double> state) {
  engine.ReadLinks(island_, state, shape_links_, states_);
  for (std::size_t i = 0; i < shapes_.size(); ++i) {
    balls_[i] = BallOf(shapes_[i], states_[static_cast<std::size_t>(shapes_[i].link)]);
  }
}

}  // namespace tcs
