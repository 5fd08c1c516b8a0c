#include "coordinator/models/urdf_skeleton.h"

#include <fmt/format.h>

#include <string_view>

#include "coordinator/errors/nearest.h"
#include "coordinator/models/urdf_customs.h"
#include "coordinator/models/urdf_grammar.h"
#include "coordinator/models/urdf_xml.h"
#include "simbody_bridge/model/joint_kinds.h"
#include "simbody_bridge/model/model_check.h"

namespace tcs {
namespace {

using tinyxml2::XMLDocument;
using tinyxml2::XMLElement;

std::string Hint(const std::string& name, const std::map<std::string, int>& names) {
  std::vector<std::string> known;
  for (const auto& [each, index] : names) known.push_back(each);
  const auto nearest = Nearest(name, known);
  return nearest ? "; did you mean " + Quoted(*nearest) + "?" : "; add it, or name another one";
}

// The number of the part `element`, which was not there before. None: a mistake, or it has no name.
std::optional<int> Enter(const XMLElement& element, const std::vector<const XMLElement*>& all,
                         std::map<std::string, int>* numbers, UrdfNotes* notes) {
  const char* name = element.Attribute("name");
  if (name == nullptr) return std::nullopt;
  const auto [entry, is_new] = numbers->try_emplace(name, static_cast<int>(numbers->size()));
  if (is_new) return entry->second;
  notes->AddMistake(
      LineOf(element),
      fmt::format("a second {} is named {}, the first is on line {}; rename one", element.Name(),
                  Quoted(name), LineOf(*all[static_cast<std::size_t>(entry->second)])));
  return std::nullopt;
}

}  // namespace

UrdfSkeleton::UrdfSkeleton(const XMLDocument& understood, UrdfNotes* notes) {
  const XMLElement& robot = *understood.RootElement();
  model_.name = robot.Attribute("name");
  for (const XMLElement* link : PartsNamed("link", robot, notes)) AddLink(*link, notes);
  for (const XMLElement* joint : PartsNamed("joint", robot, notes)) AddJoint(*joint, notes);
  if (notes->HasMistakes()) return;
  FindRoot();
  NoteFaultOf(Rigid(), notes);
}

UrdfSkeleton::Elements UrdfSkeleton::PartsNamed(std::string_view name, const XMLElement& robot,
                                                UrdfNotes* notes) const {
  Elements parts;
  for (const XMLElement* e = robot.FirstChildElement(); e != nullptr; e = e->NextSiblingElement()) {
    if (name != e->Name()) continue;
    if (parts.size() == kMostLinks) {
      notes->AddMistake(
          LineOf(*e),
          fmt::format("this is number {} of the {}s, more than tcs takes; divide the robot into "
                      "several",
                      parts.size() + 1, name));
      break;
    }
    parts.push_back(e);
  }
  return parts;
}

void UrdfSkeleton::AddLink(const XMLElement& element, UrdfNotes* notes) {
  if (!Enter(element, links_, &link_numbers_, notes)) return;
  Link link;
  link.name = element.Attribute("name");
  model_.links.push_back(link);
  links_.push_back(&element);
}

void UrdfSkeleton::AddJoint(const XMLElement& element, UrdfNotes* notes) {
  const int parent = LinkOf(element, "parent", notes), child = LinkOf(element, "child", notes);
  const auto kind = KindOf(element, notes);
  if (!Enter(element, joints_, &joint_numbers_, notes)) return;
  Joint joint;
  joint.name = element.Attribute("name");
  joint.kind = kind.value_or(JointKind::kFixed);
  joint.parent = parent;
  joint.child = child;
  model_.joints.push_back(joint);
  joints_.push_back(&element);
}

std::optional<JointKind> UrdfSkeleton::KindOf(const XMLElement& joint, UrdfNotes* notes) const {
  const char* text = joint.Attribute("type");
  if (text == nullptr) return std::nullopt;
  if (joint.Attribute(kLockedAt) != nullptr) return JointKind::kFixed;
  const std::string type = text;
  std::vector<std::string> known;
  for (const auto& [name, kind] : kJointKinds) {
    if (name == type) return kind;
    known.emplace_back(name);
  }
  notes->AddMistake(LineOf(joint), fmt::format("{} has the unknown type {}; {}", OwnerOf(joint),
                                               Quoted(type), Suggest(type, known, "types")));
  return std::nullopt;
}

int UrdfSkeleton::LinkOf(const XMLElement& joint, const char* which, UrdfNotes* notes) const {
  const XMLElement* end = joint.FirstChildElement(which);
  const char* name = end == nullptr ? nullptr : end->Attribute("link");
  if (name == nullptr) return -1;  // said already
  const auto found = link_numbers_.find(name);
  if (found != link_numbers_.end()) return found->second;
  notes->AddMistake(LineOf(*end),
                    fmt::format("{} has the {} {}, but there is no such link{}", OwnerOf(joint),
                                which, Quoted(name), Hint(name, link_numbers_)));
  return -1;
}

int UrdfSkeleton::JointNamedBy(const XMLElement& element) const {
  return joint_numbers_.at(element.Attribute("joint"));
}

// The first link that is no joint's child. Where there are several, or none, CheckModel says so.
void UrdfSkeleton::FindRoot() {
  std::vector<char> is_child(model_.links.size(), 0);
  for (const Joint& joint : model_.joints) is_child[static_cast<std::size_t>(joint.child)] = 1;
  for (std::size_t i = 0; i < is_child.size(); ++i) {
    if (is_child[i] != 0) continue;
    model_.root = static_cast<int>(i);
    return;
  }
}

// The model with nothing that could be wrong but how it hangs together.
RobotModel UrdfSkeleton::Rigid() const {
  RobotModel rigid = model_;
  rigid.has_fixed_base = true;
  for (Joint& joint : rigid.joints) joint.kind = JointKind::kFixed;
  return rigid;
}

void UrdfSkeleton::NoteFaultOf(const RobotModel& model, UrdfNotes* notes) const {
  const auto fault = CheckModel(model);
  if (!fault) return;
  const XMLElement* about = links_[0]->Parent()->ToElement();
  if (fault->joint >= 0) about = joints_[static_cast<std::size_t>(fault->joint)];
  if (fault->link >= 0) about = links_[static_cast<std::size_t>(fault->link)];
  notes->AddMistake(LineOf(*about), fault->what);
}

}  // namespace tcs
