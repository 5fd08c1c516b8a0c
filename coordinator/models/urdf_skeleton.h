// How the links and joints of a URDF file hang together, and where they stand in it.
#pragma once

#include <tinyxml2.h>

#include <map>
#include <string>
#include <vector>

#include "simbody_bridge/model/robot_model.h"

namespace tcs {

// Joints that have a lower and an upper limit.
bool HasRange(JointKind kind);

class UrdfSkeleton {
 public:
  // Of a document that UnderstoodPart has passed, and that outlives this. Throws ModelMistake for
  // what is no tree of links.
  UrdfSkeleton(const std::string& path, const tinyxml2::XMLDocument& document);

  const std::string& path() const { return path_; }
  // Names, kinds and ends; everything else is as it is in a new one.
  const RobotModel& model() const { return model_; }
  // As they stand in the file.
  const tinyxml2::XMLElement& link(std::size_t index) const { return *links_[index]; }
  const tinyxml2::XMLElement& joint(std::size_t index) const { return *joints_[index]; }
  // The index of the joint that `element` of the file names by its attribute `joint`.
  int JointNamedBy(const tinyxml2::XMLElement& element) const;

  // Throws what CheckModel finds wrong with `model`, which has the same links and joints.
  void FailOnFaultOf(const RobotModel& model) const;

 private:
  using Elements = std::vector<const tinyxml2::XMLElement*>;

  void CollectParts(const tinyxml2::XMLDocument& document);
  void AddLink(const tinyxml2::XMLElement& element);
  void AddJoint(const tinyxml2::XMLElement& element);
  JointKind KindOf(const tinyxml2::XMLElement& joint) const;
  void CheckRange(const tinyxml2::XMLElement& joint, JointKind kind) const;
  int LinkOf(const tinyxml2::XMLElement& joint, const char* which) const;
  void FindRoot();
  RobotModel Rigid() const;

  const std::string path_;
  Elements links_, joints_;
  std::map<std::string, int> link_numbers_, joint_numbers_;
  RobotModel model_;
};

}  // namespace tcs
