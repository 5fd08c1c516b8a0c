#include "coordinator/models/urdf_values.h"

#include <console_bridge/console.h>
#include <fmt/format.h>
#include <urdf_model/model.h>
#include <urdf_parser/urdf_parser.h>

#include <memory>
#include <string_view>
#include <utility>

#include "coordinator/models/model_mistake.h"
#include "coordinator/models/urdf_grammar.h"
#include "coordinator/models/urdf_xml.h"

namespace tcs {
namespace {

using tinyxml2::XMLElement;

// What liburdfdom would say on stderr, as long as this lives.
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

urdf::ModelInterfaceSharedPtr Parse(const UrdfSkeleton& skeleton,
                                    const tinyxml2::XMLDocument& understood) {
  tinyxml2::XMLPrinter printer(nullptr, true);
  understood.Print(&printer);
  const UrdfdomSpeech speech;
  const auto parsed = urdf::parseURDF(printer.CStr());
  if (parsed == nullptr) {
    FailAt(skeleton.path(), skeleton.link(0).Parent()->GetLineNum(),
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

MeshShape MeshOf(const urdf::Mesh& mesh, const UrdfSkeleton& skeleton, const XMLElement& collision,
                 const UrdfSurroundings& surroundings) {
  const XMLElement& element = *collision.FirstChildElement("geometry")->FirstChildElement("mesh");
  const auto fail = [&](std::string_view why) {
    FailAt(skeleton.path(), element.GetLineNum(), fmt::format("{}: {}", OwnerOf(element), why));
  };
  if (mesh.scale.x * mesh.scale.y * mesh.scale.z == 0) fail("the scale of a mesh is 0");
  try {
    return {surroundings.meshes.Take(surroundings.packages.Find(mesh.filename, skeleton.path()),
                                     From(mesh.scale))};
  } catch (const ModelMistake& mistake) {
    fail(mistake.message);
  }
  return {};
}

Geometry GeometryOf(const urdf::Geometry& geometry, const UrdfSkeleton& skeleton,
                    const XMLElement& collision, const UrdfSurroundings& surroundings) {
  switch (geometry.type) {
    case urdf::Geometry::BOX:
      return BoxShape{From(static_cast<const urdf::Box&>(geometry).dim)};
    case urdf::Geometry::SPHERE:
      return SphereShape{static_cast<const urdf::Sphere&>(geometry).radius};
    case urdf::Geometry::CYLINDER: {
      const auto& cylinder = static_cast<const urdf::Cylinder&>(geometry);
      return CylinderShape{cylinder.radius, cylinder.length};
    }
    case urdf::Geometry::MESH:
      break;
  }
  return MeshOf(static_cast<const urdf::Mesh&>(geometry), skeleton, collision, surroundings);
}

Link LinkOf(const urdf::Link& from, const UrdfSkeleton& skeleton, const XMLElement& element,
            const UrdfSurroundings& surroundings) {
  Link link;
  link.name = from.name;
  link.inertial = InertialOf(from);
  const XMLElement* collision = element.FirstChildElement("collision");
  for (const auto& each : from.collision_array) {
    Shape shape;
    shape.name = each->name;
    shape.geometry = GeometryOf(*each->geometry, skeleton, *collision, surroundings);
    shape.pose = From(each->origin);
    shape.friction = surroundings.friction;
    link.shapes.push_back(std::move(shape));
    collision = collision->NextSiblingElement("collision");
  }
  return link;
}

JointLimits LimitsOf(const urdf::Joint& from, const Joint& joint, const UrdfSkeleton& skeleton,
                     const XMLElement& element, std::vector<std::string>* warnings) {
  JointLimits limits;
  const auto warn = [&](std::string_view what) {
    warnings->push_back(
        fmt::format("{}:{}: {} {}", skeleton.path(), element.GetLineNum(), OwnerOf(element), what));
  };
  if (from.limits == nullptr || joint.kind == JointKind::kFixed) return limits;
  if (CoordinatesOf(joint.kind) != 1) {
    warn("has a <limit>, which means nothing for a joint of its type and is left out");
    return limits;
  }
  limits.effort = from.limits->effort;
  limits.velocity = from.limits->velocity;
  if (!HasRange(joint.kind)) return limits;
  limits.lower = from.limits->lower;
  limits.upper = from.limits->upper;
  if (limits.lower == limits.upper) {
    warn(fmt::format("cannot move: both its limits are {}{}", limits.lower,
                     limits.lower == 0 ? ", as they are where they are not given" : ""));
  }
  return limits;
}

void TakeJoint(const urdf::Joint& from, const UrdfSkeleton& skeleton, const XMLElement& element,
               std::vector<std::string>* warnings, Joint* joint) {
  joint->origin = From(from.parent_to_joint_origin_transform);
  if (joint->kind != JointKind::kFixed && joint->kind != JointKind::kFloating) {
    joint->axis = From(from.axis);
  }
  joint->limits = LimitsOf(from, *joint, skeleton, element, warnings);
  if (from.dynamics != nullptr && joint->kind != JointKind::kFixed) {
    joint->damping = from.dynamics->damping;
    joint->friction = from.dynamics->friction;
  }
  if (from.mimic != nullptr) {
    joint->mimic = Mimic{skeleton.JointNamedBy(*element.FirstChildElement("mimic")),
                         from.mimic->multiplier, from.mimic->offset};
  }
}

}  // namespace

RobotModel WithValues(const UrdfSkeleton& skeleton, const tinyxml2::XMLDocument& understood,
                      const UrdfSurroundings& surroundings, std::vector<std::string>* warnings) {
  const urdf::ModelInterfaceSharedPtr parsed = Parse(skeleton, understood);
  RobotModel model = skeleton.model();
  for (std::size_t i = 0; i < model.links.size(); ++i) {
    model.links[i] =
        LinkOf(*parsed->getLink(model.links[i].name), skeleton, skeleton.link(i), surroundings);
  }
  for (std::size_t i = 0; i < model.joints.size(); ++i) {
    TakeJoint(*parsed->getJoint(model.joints[i].name), skeleton, skeleton.joint(i), warnings,
              &model.joints[i]);
  }
  return model;
}

}  // namespace tcs
