#include "coordinator/models/urdf_customs.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "coordinator/errors/nearest.h"
#include "coordinator/models/urdf_grammar.h"
#include "coordinator/models/urdf_xml.h"

namespace tcs {
namespace {

using tinyxml2::XMLDocument;
using tinyxml2::XMLElement;

std::vector<XMLElement*> ChildrenNamed(XMLElement* parent, const char* name) {
  std::vector<XMLElement*> children;
  for (XMLElement* e = parent->FirstChildElement(name); e != nullptr;
       e = e->NextSiblingElement(name)) {
    children.push_back(e);
  }
  return children;
}

std::string_view TextOf(const XMLElement& element, const char* attribute) {
  const char* text = element.Attribute(attribute);
  return text == nullptr ? "" : text;
}

bool IsType(const XMLElement& joint, std::string_view type) {
  return TextOf(joint, "type") == type;
}

bool HasOneCoordinate(const XMLElement& joint) {
  return IsType(joint, "revolute") || IsType(joint, "continuous") || IsType(joint, "prismatic");
}

// Whether one of the shape's sizes is 0.
bool HasZero(const XMLElement& shape) {
  for (const char* name : {"size", "radius", "length"}) {
    std::string_view rest = TextOf(shape, name);
    while (!rest.empty()) {
      const std::size_t end = std::min(rest.find(' '), rest.size());
      if (rest.substr(0, end) == "0" || rest.substr(0, end) == "-0") return true;
      rest.remove_prefix(std::min(end + 1, rest.size()));
    }
  }
  return false;
}

void TakeInertial(XMLElement* link, UrdfNotes* notes) {
  XMLElement* inertial = link->FirstChildElement("inertial");
  XMLElement* inertia = inertial == nullptr ? nullptr : inertial->FirstChildElement("inertia");
  if (inertia == nullptr) return;
  for (const char* product : {"ixy", "ixz", "iyz"}) {
    if (inertia->Attribute(product) != nullptr) continue;
    notes->AddMend(
        "no product", LineOf(*inertia),
        fmt::format("<inertia> in {} has no {}, and 0 is taken", OwnerOf(*link), product));
    inertia->SetAttribute(product, "0");
  }
}

// liburdfdom knows no capsules until its release 4.
void TakeCapsule(XMLElement* shape) {
  if (shape->DoubleAttribute("length", 0) > 0) {
    shape->SetName("cylinder");
    shape->SetAttribute(kIsCapsule, true);
  } else {
    shape->SetName("sphere");
    shape->DeleteAttribute("length");
  }
}

void TakeShapes(XMLElement* link, UrdfNotes* notes) {
  for (XMLElement* collision : ChildrenNamed(link, "collision")) {
    XMLElement* geometry = collision->FirstChildElement("geometry");
    XMLElement* shape = geometry == nullptr ? nullptr : geometry->FirstChildElement();
    if (shape == nullptr) continue;  // said already
    const std::string name = shape->Name();
    // A capsule without its cylinder is a ball, and as such it is there.
    const bool is_ball = name == "capsule" && TextOf(*shape, "radius") != "0";
    if (HasZero(*shape) && !is_ball) {
      notes->AddMend("size of 0", LineOf(*shape),
                     fmt::format("the {} in {} has a size of 0 and is left out of its collision "
                                 "shapes",
                                 name, OwnerOf(*link)));
      link->DeleteChild(collision);
    } else if (name == "capsule") {
      TakeCapsule(shape);
    }
  }
}

class Joints {
 public:
  Joints(XMLElement* robot, UrdfNotes* notes) : notes_(*notes) {
    for (XMLElement* joint : ChildrenNamed(robot, "joint")) {
      all_.push_back(joint);
      if (const char* name = joint->Attribute("name")) by_name_.try_emplace(name, joint);
    }
  }

  void Take() {
    for (XMLElement* joint : all_) TakeLimit(joint);
    for (XMLElement* joint : all_) FindLeader(joint);
    for (XMLElement* joint : all_) Follow(joint);
  }

 private:
  // The joint that a joint follows in the end.
  struct Leading {
    const XMLElement* leader = nullptr;
    double multiplier = 1;
    double offset = 0;
  };

  void Mend(std::string_view kind, const XMLElement& at, const XMLElement& joint,
            std::string_view what) {
    notes_.AddMend(kind, LineOf(at), fmt::format("{} {}", OwnerOf(joint), what));
  }

  void TakeLimit(XMLElement* joint) {
    XMLElement* limit = joint->FirstChildElement("limit");
    const bool has_range = IsType(*joint, "revolute") || IsType(*joint, "prismatic");
    if (limit == nullptr && has_range) {
      limit = joint->InsertNewChildElement("limit");
      Mend("no limit", *joint, *joint, "has no <limit>: no range, effort or velocity limits it");
    } else if (limit != nullptr && HasOneCoordinate(*joint)) {
      TakeBounds(joint, limit);
      if (has_range) TakeRange(joint, limit);
    }
    if (limit == nullptr) return;
    for (const char* bound : {"effort", "velocity"}) {
      if (!(limit->DoubleAttribute(bound, 0) > 0)) limit->SetAttribute(bound, "0");
    }
  }

  // The bounds of a joint's drive: nothing drives a follower.
  void TakeBounds(XMLElement* joint, XMLElement* limit) {
    if (joint->FirstChildElement("mimic") != nullptr) return;
    for (const char* bound : {"effort", "velocity"}) {
      const double value = limit->DoubleAttribute(bound, 0);
      if (value > 0) continue;
      const bool is_there = limit->Attribute(bound) != nullptr;
      Mend(fmt::format("{} {}", is_there ? "void" : "no", bound), *limit, *joint,
           is_there ? fmt::format("has the limit {}=\"{}\", which is taken for none", bound, value)
                    : fmt::format("has a <limit> without {}, so that nothing limits that", bound));
    }
  }

  void TakeRange(XMLElement* joint, XMLElement* limit) {
    const bool is_there =
        limit->Attribute("lower") != nullptr || limit->Attribute("upper") != nullptr;
    const double lower = limit->DoubleAttribute("lower", 0);
    const double upper = limit->DoubleAttribute("upper", 0);
    if (!is_there) {
      Mend("no range", *limit, *joint,
           "has a <limit> without lower and upper, so that it has no range and moves freely");
    } else if (lower > upper) {
      Mend("turned range", *limit, *joint,
           fmt::format("has a lower limit {} above its upper limit {}, which is taken for no range",
                       lower, upper));
      limit->DeleteAttribute("lower");
      limit->DeleteAttribute("upper");
    } else if (lower == upper) {
      Mend("empty range", *limit, *joint,
           fmt::format("cannot move, because both its limits are {}; it is taken for a fixed joint",
                       lower));
      joint->SetAttribute(kLockedAt, lower);
    } else {
      // Both bounds are set, for readers that ask for either.
      limit->SetAttribute("lower", lower);
      limit->SetAttribute("upper", upper);
    }
  }

  static bool IsLocked(const XMLElement& joint) { return joint.Attribute(kLockedAt) != nullptr; }

  void RemoveMimic(XMLElement* joint) { joint->DeleteChild(joint->FirstChildElement("mimic")); }

  // Finds the leader in the joint's own <mimic>.
  void FindLeader(XMLElement* joint) {
    const XMLElement* mimic = joint->FirstChildElement("mimic");
    if (mimic == nullptr) return;
    const char* name = mimic->Attribute("joint");
    if (name == nullptr) return RemoveMimic(joint);  // a mistake, which has been said
    const auto leave_out = [&](std::string_view why) {
      Mend(why, *mimic, *joint, fmt::format("{}, and its <mimic> is left out", why));
      RemoveMimic(joint);
    };
    if (!HasOneCoordinate(*joint)) return leave_out("has not one coordinate to follow another by");
    if (IsLocked(*joint)) return leave_out("cannot move");
    const auto leader = by_name_.find(name);
    if (leader == by_name_.end()) {
      std::vector<std::string> names;
      for (const auto& [each, element] : by_name_) names.push_back(each);
      const auto nearest = Nearest(name, names);
      Mend("no leader", *mimic, *joint,
           fmt::format("follows {}, but there is no such joint, so it moves by itself{}",
                       Quoted(name),
                       nearest ? "; did you mean " + Quoted(*nearest) + "?" : std::string()));
      RemoveMimic(joint);
      return;
    }
    if (IsType(*leader->second, "planar") || IsType(*leader->second, "floating")) {
      leave_out("follows a joint that has not one coordinate");
    }
  }

  // Goes from leader to leader, to the joint that moves by itself.
  std::optional<Leading> LeadingOf(const XMLElement& follower) const {
    Leading leading;
    const XMLElement* at = &follower;
    for (std::size_t steps = 0; steps <= all_.size(); ++steps) {
      const XMLElement* mimic = at->FirstChildElement("mimic");
      if (mimic == nullptr) {
        leading.leader = at;
        return leading;
      }
      leading.offset += leading.multiplier * mimic->DoubleAttribute("offset", 0);
      leading.multiplier *= mimic->DoubleAttribute("multiplier", 1);
      at = by_name_.at(TextOf(*mimic, "joint").data());
    }
    return std::nullopt;
  }

  void Follow(XMLElement* joint) {
    XMLElement* mimic = joint->FirstChildElement("mimic");
    if (mimic == nullptr) return;
    const auto leading = LeadingOf(*joint);
    if (!leading) {
      notes_.AddMistake(LineOf(*mimic),
                        fmt::format("{} follows itself in the end; let it follow a joint that "
                                    "moves by itself",
                                    OwnerOf(*joint)));
      return;
    }
    const XMLElement& leader = *leading->leader;
    if (IsType(leader, "fixed") || IsLocked(leader)) {
      const double at =
          leading->offset + leading->multiplier * leader.DoubleAttribute(kLockedAt, 0);
      Mend("leader stands", *mimic, *joint,
           fmt::format("follows {}, which cannot move; it is taken for a joint that is fixed at {}",
                       OwnerOf(leader), at));
      standing_.push_back({joint, at});
      return;
    }
    following_.push_back({mimic, *leading});
  }

 public:
  // Called once all joints have been followed to their leaders.
  void Write() {
    for (const auto& [joint, at] : standing_) {
      RemoveMimic(joint);
      joint->SetAttribute(kLockedAt, at);
    }
    for (const auto& [mimic, leading] : following_) {
      mimic->SetAttribute("joint", leading.leader->Attribute("name"));
      mimic->SetAttribute("multiplier", fmt::format("{}", leading.multiplier).c_str());
      mimic->SetAttribute("offset", fmt::format("{}", leading.offset).c_str());
    }
  }

 private:
  UrdfNotes& notes_;
  std::vector<XMLElement*> all_;
  std::map<std::string, XMLElement*> by_name_;
  std::vector<std::pair<XMLElement*, double>> standing_;
  std::vector<std::pair<XMLElement*, Leading>> following_;
};

// Links that no joint names, beside a robot that has some.
void LeaveLoneLinksOut(XMLElement* robot, UrdfNotes* notes) {
  std::set<std::string_view> named;
  for (XMLElement* joint : ChildrenNamed(robot, "joint")) {
    for (const char* end : {"parent", "child"}) {
      const XMLElement* element = joint->FirstChildElement(end);
      if (element != nullptr) named.insert(TextOf(*element, "link"));
    }
  }
  std::vector<XMLElement*> links = ChildrenNamed(robot, "link");
  // Links that a misspelt end leaves alone are no lone links, and too many links are a mistake.
  std::set<std::string_view> known;
  for (XMLElement* link : links) known.insert(TextOf(*link, "name"));
  if (links.size() > kMostLinks || !std::ranges::includes(known, named)) return;
  // Of a robot without joints the first link is the robot.
  if (named.empty() && !links.empty()) named.insert(TextOf(*links[0], "name"));
  for (XMLElement* link : links) {
    const char* name = link->Attribute("name");
    if (name == nullptr || named.contains(name)) continue;
    notes->AddMend(
        "lone link", LineOf(*link),
        fmt::format("{} is left out, because no joint joins it to the robot", OwnerOf(*link)));
    robot->DeleteChild(link);
  }
}

}  // namespace

void WithCustoms(XMLDocument* understood, UrdfNotes* notes) {
  XMLElement* robot = understood->RootElement();
  if (robot->Attribute("name") == nullptr) {
    notes->AddWarning(LineOf(*robot),
                      "this <robot> has no name, which some programs of ROS refuse; write <robot "
                      "name=\"…\">");
    robot->SetAttribute("name", "robot");
  }
  LeaveLoneLinksOut(robot, notes);
  for (XMLElement* link : ChildrenNamed(robot, "link")) {
    TakeInertial(link, notes);
    TakeShapes(link, notes);
  }
  Joints joints(robot, notes);
  joints.Take();
  joints.Write();
}

}  // namespace tcs
