#include "coordinator/models/urdf_values.h"

#include <console_bridge/console.h>
#include <fmt/format.h>
#include <urdf_model/model.h>
#include <urdf_parser/urdf_parser.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string_view>
#include <utility>

#include "coordinator/models/model_mistake.h"
#include "coordinator/models/urdf_customs.h"
#include "coordinator/models/urdf_grammar.h"
#include "coordinator/models/urdf_xml.h"
#include "simbody_bridge/model/vectors.h"

namespace tcs {
namespace {

using tinyxml2::XMLElement;

// Takes what liburdfdom would say on stderr, as long as the object lives.
class UrdfdomSpeech : public console_bridge::OutputHandler {
 public:
  UrdfdomSpeech() { console_bridge::useOutputHandler(this); }
  ~UrdfdomSpeech() override { console_bridge::restorePreviousOutputHandler(); }
  UrdfdomSpeech(const UrdfdomSpeech&) = delete;
  UrdfdomSpeech& operator=(const UrdfdomSpeech&) = delete;

  const std::string& first_error() const { return first_error_; }

 private:
  void log(const std::string& text, console_bridge::LogLevel level, const char*, int) override {
    if (level >= console_bridge::CONSOLE_BRIDGE_LOG_ERROR && first_error_.empty()) {
      first_error_ = text;
    }
  }

  std::string first_error_;
};

// Null: a mistake.
urdf::ModelInterfaceSharedPtr Parse(const tinyxml2::XMLDocument& understood, UrdfNotes* notes) {
  tinyxml2::XMLPrinter printer(nullptr, true);
  understood.Print(&printer);
  const UrdfdomSpeech speech;
  auto parsed = urdf::parseURDF(printer.CStr());
  if (parsed == nullptr) {
    notes->AddMistake(LineOf(*understood.RootElement()),
                      "liburdfdom refuses this robot: " + Quoted(speech.first_error()));
  }
  return parsed;
}

std::array<double, 3> From(const urdf::Vector3& v) { return {v.x, v.y, v.z}; }

Pose From(const urdf::Pose& pose) {
  const urdf::Rotation& q = pose.rotation;
  return {From(pose.position), Normalised({q.x, q.y, q.z, q.w})};
}

// A mass of 0 with no inertia is how many files write a frame.
std::optional<Inertial> InertialOf(const urdf::Link& link) {
  if (link.inertial == nullptr) return std::nullopt;
  const urdf::Inertial& from = *link.inertial;
  const bool is_nothing = from.mass == 0 && from.ixx == 0 && from.iyy == 0 && from.izz == 0 &&
                          from.ixy == 0 && from.ixz == 0 && from.iyz == 0;
  if (is_nothing) return std::nullopt;
  Inertial inertial;
  inertial.mass_kg = from.mass;
  inertial.frame = From(from.origin);
  inertial.ixx_kgm2 = from.ixx;
  inertial.iyy_kgm2 = from.iyy;
  inertial.izz_kgm2 = from.izz;
  inertial.ixy_kgm2 = from.ixy;
  inertial.ixz_kgm2 = from.ixz;
  inertial.iyz_kgm2 = from.iyz;
  return inertial;
}

// None: a mistake, or nothing that could collide, which is said.
std::optional<Geometry> MeshOf(const urdf::Mesh& mesh, const XMLElement& element,
                               const UrdfSurroundings& surroundings, UrdfNotes* notes) {
  const auto mistake = [&](std::string_view why) {
    notes->AddMistake(LineOf(element), fmt::format("{}: {}", OwnerOf(element), why));
    return std::nullopt;
  };
  try {
    const std::string path = surroundings.packages.Find(mesh.filename, surroundings.described_in);
    const auto taken = surroundings.meshes.Take(path, From(mesh.scale));
    if (taken == nullptr) {
      notes->AddMend("line", LineOf(element),
                     fmt::format("the mesh {} in {} is a point or a line and is left out of its "
                                 "collision shapes",
                                 path, OwnerOf(element)));
      return std::nullopt;
    }
    if (surroundings.meshes.IsFlat(path, From(mesh.scale))) {
      notes->AddMend(
          "flat mesh", LineOf(element),
          fmt::format("the mesh {} in {} is flat, and is taken as a plate of 1/200 of its extent",
                      path, OwnerOf(element)));
    }
    return MeshShape{taken};
  } catch (const ModelMistake& mistaken) {
    return mistake(mistaken.message);
  }
}

std::optional<Geometry> GeometryOf(const urdf::Geometry& geometry, const XMLElement& element,
                                   const UrdfSurroundings& surroundings, UrdfNotes* notes) {
  switch (geometry.type) {
    case urdf::Geometry::BOX:
      return BoxShape{From(static_cast<const urdf::Box&>(geometry).dim)};
    case urdf::Geometry::SPHERE:
      return SphereShape{static_cast<const urdf::Sphere&>(geometry).radius};
    case urdf::Geometry::CYLINDER: {
      const auto& cylinder = static_cast<const urdf::Cylinder&>(geometry);
      if (element.BoolAttribute(kIsCapsule)) return CapsuleShape{cylinder.radius, cylinder.length};
      return CylinderShape{cylinder.radius, cylinder.length};
    }
    case urdf::Geometry::MESH:
      break;
  }
  return MeshOf(static_cast<const urdf::Mesh&>(geometry), element, surroundings, notes);
}

Link LinkOf(const urdf::Link& from, const XMLElement& element, const UrdfSurroundings& surroundings,
            UrdfNotes* notes) {
  Link link;
  link.name = from.name;
  link.inertial = InertialOf(from);
  const XMLElement* collision = element.FirstChildElement("collision");
  for (const auto& each : from.collision_array) {
    auto geometry =
        GeometryOf(*each->geometry, *collision->FirstChildElement("geometry")->FirstChildElement(),
                   surroundings, notes);
    collision = collision->NextSiblingElement("collision");
    if (!geometry) continue;
    Shape shape;
    shape.name = each->name;
    shape.geometry = std::move(*geometry);
    shape.pose = From(each->origin);
    link.shapes.push_back(std::move(shape));
  }
  return link;
}

JointLimits LimitsOf(const urdf::Joint& from, const Joint& joint, const XMLElement& element,
                     UrdfNotes* notes) {
  JointLimits limits;
  const XMLElement* limit = element.FirstChildElement("limit");
  if (from.limits == nullptr || limit == nullptr || joint.kind == JointKind::kFixed) return limits;
  if (CoordinatesOf(joint.kind) != 1) {
    notes->AddMend("limit without meaning", LineOf(element),
                   OwnerOf(element) +
                       " has a <limit>, which means nothing for a joint of its type and is left "
                       "out");
    return limits;
  }
  if (from.limits->effort > 0) limits.effort = from.limits->effort;
  if (from.limits->velocity > 0) limits.velocity = from.limits->velocity;
  if (joint.kind == JointKind::kContinuous || limit->Attribute("lower") == nullptr) return limits;
  limits.lower = from.limits->lower;
  limits.upper = from.limits->upper;
  return limits;
}

// The pose of the child of a joint that stands at `position`, seen from the child's pose at 0.
Pose MovedBy(const std::array<double, 3>& axis, double position, bool is_prismatic) {
  Pose pose;
  const double length = std::sqrt(Dot(axis, axis));
  if (!(length > 0)) return pose;
  for (std::size_t i = 0; i < 3; ++i) {
    if (is_prismatic) pose.position_m[i] = axis[i] / length * position;
    if (!is_prismatic) pose.orientation_xyzw[i] = axis[i] / length * std::sin(position / 2);
  }
  if (!is_prismatic) pose.orientation_xyzw[3] = std::cos(position / 2);
  return pose;
}

void TakeJoint(const urdf::Joint& from, const UrdfSkeleton& skeleton, const XMLElement& element,
               UrdfNotes* notes, Joint* joint) {
  joint->origin = From(from.parent_to_joint_origin_transform);
  if (element.Attribute(kLockedAt) != nullptr) {
    joint->origin =
        Times(joint->origin, MovedBy(From(from.axis), element.DoubleAttribute(kLockedAt),
                                     from.type == urdf::Joint::PRISMATIC));
    return;
  }
  if (joint->kind != JointKind::kFixed && joint->kind != JointKind::kFloating) {
    joint->axis = From(from.axis);
  }
  joint->limits = LimitsOf(from, *joint, element, notes);
  if (from.dynamics != nullptr && joint->kind != JointKind::kFixed) {
    joint->damping = from.dynamics->damping;
    joint->friction = from.dynamics->friction;
  }
  if (from.mimic != nullptr) {
    joint->mimic = Mimic{skeleton.JointNamedBy(*element.FirstChildElement("mimic")),
                         from.mimic->multiplier, from.mimic->offset};
  }
}

// A joint that follows a leader allows it no more than the follower's own limits do: the leader's
// range is what all of them allow, and limits of the followers say nothing more.
void JoinRanges(const UrdfSkeleton& skeleton, RobotModel* model, UrdfNotes* notes) {
  for (std::size_t i = 0; i < model->joints.size(); ++i) {
    Joint& joint = model->joints[i];
    if (!joint.mimic.has_value()) continue;
    const JointLimits own = joint.limits;
    joint.limits.lower = -kNoLimit;
    joint.limits.upper = kNoLimit;
    const Mimic& mimic = *joint.mimic;
    if (mimic.multiplier == 0 || (own.lower == -kNoLimit && own.upper == kNoLimit)) continue;
    Joint& leader = model->joints[static_cast<std::size_t>(mimic.joint)];
    double lower = (own.lower - mimic.offset) / mimic.multiplier;
    double upper = (own.upper - mimic.offset) / mimic.multiplier;
    if (lower > upper) std::swap(lower, upper);
    const double common_lower = std::max(lower, leader.limits.lower);
    const double common_upper = std::min(upper, leader.limits.upper);
    const XMLElement& element = skeleton.joint(i);
    const auto follows = [&] {
      return fmt::format("{} follows joint {} with limits {} and {}", OwnerOf(element),
                         Quoted(leader.name), own.lower, own.upper);
    };
    if (!(common_lower < common_upper)) {
      notes->AddMend("fights its leader", LineOf(element),
                     fmt::format("{} that its leader, which is between {} and {}, never takes it "
                                 "to; they are left out",
                                 follows(), leader.limits.lower, leader.limits.upper));
      continue;
    }
    // Only a difference beyond rounding by hand is noted.
    const double tolerance = 1e-3 * (common_upper - common_lower);
    const bool had_range =
        leader.kind != JointKind::kContinuous && leader.limits.lower != -kNoLimit;
    if (had_range && (common_lower > leader.limits.lower + tolerance ||
                      common_upper < leader.limits.upper - tolerance)) {
      notes->AddMend("narrows its leader", LineOf(element),
                     fmt::format("{}, so its leader may go from {} to {} only", follows(),
                                 common_lower, common_upper));
    }
    // A continuous joint that leads a joint with limits does not turn for ever.
    if (leader.kind == JointKind::kContinuous) leader.kind = JointKind::kRevolute;
    leader.limits.lower = common_lower;
    leader.limits.upper = common_upper;
  }
}

}  // namespace

RobotModel WithValues(const UrdfSkeleton& skeleton, const tinyxml2::XMLDocument& understood,
                      const UrdfSurroundings& surroundings, UrdfNotes* notes) {
  RobotModel model = skeleton.model();
  const urdf::ModelInterfaceSharedPtr parsed = Parse(understood, notes);
  if (parsed == nullptr) return model;
  for (std::size_t i = 0; i < model.links.size(); ++i) {
    model.links[i] =
        LinkOf(*parsed->getLink(model.links[i].name), skeleton.link(i), surroundings, notes);
  }
  for (std::size_t i = 0; i < model.joints.size(); ++i) {
    TakeJoint(*parsed->getJoint(model.joints[i].name), skeleton, skeleton.joint(i), notes,
              &model.joints[i]);
  }
  JoinRanges(skeleton, &model, notes);
  return model;
}

}  // namespace tcs
