#include "coordinator/models/urdf_skeleton.h"

#include <fmt/format.h>

#include <string_view>

#include "coordinator/models/urdf_grammar.h"
#include "coordinator/models/urdf_xml.h"
#include "coordinator/scenario/nearest.h"
#include "simbody_bridge/model/joint_kinds.h"
#include "simbody_bridge/model/model_check.h"

namespace tcs {
namespace {

using tinyxml2::XMLDocument;
using tinyxml2::XMLElement;

constexpr std::size_t kMostLinks = 4096;

int LineOf(const std::vector<const XMLElement*>& elements, int index) {
  return elements[static_cast<std::size_t>(index)]->GetLineNum();
}

std::string Hint(const std::string& name, const std::map<std::string, int>& names) {
  std::vector<std::string> known;
  for (const auto& [each, index] : names) known.push_back(each);
  const auto nearest = Nearest(name, known);
  return nearest ? "; did you mean " + Quoted(*nearest) + "?" : "; add it, or name another one";
}

// The number of the part `element`, which was not there before.
int Enter(const std::string& path, const XMLElement& element,
          const std::vector<const XMLElement*>& all, std::map<std::string, int>* numbers) {
  const std::string name = element.Attribute("name");
  const auto [entry, is_new] = numbers->try_emplace(name, static_cast<int>(numbers->size()));
  if (is_new) return entry->second;
  FailAt(path, element.GetLineNum(),
         fmt::format("a second {} is named {}, the first is on line {}; rename one", element.Name(),
                     Quoted(name), LineOf(all, entry->second)));
}

}  // namespace

bool HasRange(JointKind kind) {
  return kind == JointKind::kRevolute || kind == JointKind::kPrismatic;
}

UrdfSkeleton::UrdfSkeleton(const std::string& path, const XMLDocument& document) : path_(path) {
  CollectParts(document);
  model_.name = document.RootElement()->Attribute("name");
  for (const XMLElement* link : links_) AddLink(*link);
  for (const XMLElement* joint : joints_) AddJoint(*joint);
  FindRoot();
  FailOnFaultOf(Rigid());
}

void UrdfSkeleton::CollectParts(const XMLDocument& document) {
  for (const XMLElement* e = document.RootElement()->FirstChildElement(); e != nullptr;
       e = e->NextSiblingElement()) {
    const std::string_view name = e->Name();
    if (name != "link" && name != "joint") continue;
    Elements& parts = name == "link" ? links_ : joints_;
    parts.push_back(e);
    if (parts.size() <= kMostLinks) continue;
    FailAt(path_, e->GetLineNum(),
           fmt::format(
               "this is number {} of the {}s, more than tcs takes; divide the robot into several",
               parts.size(), name));
  }
}

void UrdfSkeleton::AddLink(const XMLElement& element) {
  Enter(path_, element, links_, &link_numbers_);
  Link link;
  link.name = element.Attribute("name");
  model_.links.push_back(link);
}

void UrdfSkeleton::AddJoint(const XMLElement& element) {
  Enter(path_, element, joints_, &joint_numbers_);
  Joint joint;
  joint.name = element.Attribute("name");
  joint.kind = KindOf(element);
  CheckRange(element, joint.kind);
  joint.parent = LinkOf(element, "parent");
  joint.child = LinkOf(element, "child");
  model_.joints.push_back(joint);
}

JointKind UrdfSkeleton::KindOf(const XMLElement& joint) const {
  const std::string type = joint.Attribute("type");
  std::vector<std::string> known;
  for (const auto& [name, kind] : kJointKinds) {
    if (name == type) return kind;
    known.emplace_back(name);
  }
  FailAt(path_, joint.GetLineNum(),
         fmt::format("{} has the unknown type {}; {}", OwnerOf(joint), Quoted(type),
                     Suggest(type, known, "types")));
}

void UrdfSkeleton::CheckRange(const XMLElement& joint, JointKind kind) const {
  if (!HasRange(kind) || joint.FirstChildElement("limit") != nullptr) return;
  FailAt(path_, joint.GetLineNum(),
         fmt::format(
             "{} has no <limit>; add <limit lower=\"…\" upper=\"…\" effort=\"…\" "
             "velocity=\"…\"/>{}",
             OwnerOf(joint),
             kind == JointKind::kRevolute ? ", or make it continuous if it turns for ever" : ""));
}

int UrdfSkeleton::LinkOf(const XMLElement& joint, const char* which) const {
  const XMLElement& end = *joint.FirstChildElement(which);
  const std::string name = end.Attribute("link");
  const auto found = link_numbers_.find(name);
  if (found != link_numbers_.end()) return found->second;
  FailAt(path_, end.GetLineNum(),
         fmt::format("{} has the {} {}, but there is no such link{}", OwnerOf(joint), which,
                     Quoted(name), Hint(name, link_numbers_)));
}

int UrdfSkeleton::JointNamedBy(const XMLElement& element) const {
  const std::string name = element.Attribute("joint");
  const auto found = joint_numbers_.find(name);
  if (found != joint_numbers_.end()) return found->second;
  FailAt(path_, element.GetLineNum(),
         fmt::format("{} follows {}, but there is no such joint{}", OwnerOf(element), Quoted(name),
                     Hint(name, joint_numbers_)));
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

// With nothing that could be wrong but how it hangs together.
RobotModel UrdfSkeleton::Rigid() const {
  RobotModel rigid = model_;
  rigid.has_fixed_base = true;
  for (Joint& joint : rigid.joints) joint.kind = JointKind::kFixed;
  return rigid;
}

void UrdfSkeleton::FailOnFaultOf(const RobotModel& model) const {
  const auto fault = CheckModel(model);
  if (!fault) return;
  int line = links_[0]->Parent()->GetLineNum();
  if (fault->joint >= 0) line = LineOf(joints_, fault->joint);
  if (fault->link >= 0) line = LineOf(links_, fault->link);
  FailAt(path_, line, fault->what);
}

}  // namespace tcs
