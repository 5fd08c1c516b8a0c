// How the links and joints of a URDF file hang together, and where they stand in it.
#pragma once

#include <tinyxml2.h>

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "coordinator/models/urdf_notes.h"
#include "simbody_bridge/model/robot_model.h"

namespace tcs {

class UrdfSkeleton {
 public:
  // The skeleton of a document of UnderstoodPart that WithCustoms has passed, and that outlives
  // this. Links that are no tree are a mistake in `notes`; where `notes` has mistakes, the skeleton
  // is not whole, and of no use.
  UrdfSkeleton(const tinyxml2::XMLDocument& understood, UrdfNotes* notes);

  // A model with names, kinds and ends; everything else is as in a new model.
  const RobotModel& model() const { return model_; }
  const tinyxml2::XMLElement& link(std::size_t index) const { return *links_[index]; }
  const tinyxml2::XMLElement& joint(std::size_t index) const { return *joints_[index]; }
  // The index of the joint that `element` names by its attribute `joint`, which there is.
  int JointNamedBy(const tinyxml2::XMLElement& element) const;

  // Notes what CheckModel finds wrong with `model`, which has the same links and joints.
  void NoteFaultOf(const RobotModel& model, UrdfNotes* notes) const;

 private:
  using Elements = std::vector<const tinyxml2::XMLElement*>;

  Elements PartsNamed(std::string_view name, const tinyxml2::XMLElement& robot,
                      UrdfNotes* notes) const;
  void AddLink(const tinyxml2::XMLElement& element, UrdfNotes* notes);
  void AddJoint(const tinyxml2::XMLElement& element, UrdfNotes* notes);
  std::optional<JointKind> KindOf(const tinyxml2::XMLElement& joint, UrdfNotes* notes) const;
  int LinkOf(const tinyxml2::XMLElement& joint, const char* which, UrdfNotes* notes) const;
  void FindRoot();
  RobotModel Rigid() const;

  Elements links_, joints_;
  std::map<std::string, int> link_numbers_, joint_numbers_;
  RobotModel model_;
};

}  // namespace tcs
