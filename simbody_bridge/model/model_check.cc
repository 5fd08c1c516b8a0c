#include "simbody_bridge/model/model_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <unordered_set>
#include <utility>

#include "simbody_bridge/model/convex_hull.h"
#include "simbody_bridge/model/finite.h"
#include "simbody_bridge/model/principal_axes.h"
#include "simbody_bridge/model/rigid_tree.h"

namespace tcs {
namespace {

using Fault = std::optional<ModelFault>;

constexpr double kOrientationTolerance = 1e-3;
// Sums of inertias that CAD has rounded to some digits.
constexpr double kInertiaTolerance = 1e-6;

bool IsUnit(const std::array<double, 4>& q) {
  const double square = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
  return std::abs(std::sqrt(square) - 1) <= kOrientationTolerance;
}
bool IsPose(const Pose& pose) { return AllFinite(pose) && IsUnit(pose.orientation_xyzw); }

std::optional<std::string> CheckInertial(const Inertial& inertial) {
  if (!IsPositive(inertial.mass_kg)) {
    return fmt::format("its mass must be positive and finite, but is {} kg", inertial.mass_kg);
  }
  if (!IsPose(inertial.frame)) return "the frame of its inertia is no pose";
  const std::array<double, 6> elements = {inertial.ixx_kgm2, inertial.iyy_kgm2, inertial.izz_kgm2,
                                          inertial.ixy_kgm2, inertial.ixz_kgm2, inertial.iyz_kgm2};
  if (!AllFinite(elements)) return "its inertia must be finite";
  return {};
}

// Checks the inertia of a body: links that are fixed to each other only add to it.
std::optional<std::string> CheckInertia(const Matrix3& inertia_kgm2) {
  const std::array<double, 3> moments = PrincipalAxesOf(inertia_kgm2).moments;
  const auto text =
      fmt::format("({:.6g}, {:.6g}, {:.6g}) kg m^2", moments[0], moments[1], moments[2]);
  if (!(moments[0] > 0)) {
    return fmt::format("its principal moments of inertia must be positive, but are {}", text);
  }
  if (moments[2] > moments[0] + moments[1] + kInertiaTolerance * moments[2]) {
    return fmt::format(
        "no rigid body has its principal moments of inertia {}, because one of them exceeds the "
        "sum of the two others",
        text);
  }
  return {};
}

std::optional<std::string> CheckSize(double value, std::string_view what) {
  if (IsPositive(value)) return {};
  return fmt::format("the {} must be positive and finite, but is {} m", what, value);
}

std::optional<std::string> CheckMesh(const Mesh& mesh) {
  if (mesh.vertices_m.size() < 4) {
    return fmt::format("the mesh '{}' encloses nothing: it has {} vertices", mesh.name,
                       mesh.vertices_m.size());
  }
  for (const auto& vertex : mesh.vertices_m) {
    if (!AllFinite(vertex)) {
      return fmt::format("the mesh '{}' has a vertex that is not finite", mesh.name);
    }
  }
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t vertex : triangle) {
      if (vertex >= mesh.vertices_m.size()) {
        return fmt::format("the mesh '{}' has a triangle of vertex {}, but {} vertices", mesh.name,
                           vertex, mesh.vertices_m.size());
      }
    }
  }
  if (!SpansVolume(mesh.vertices_m)) {
    return fmt::format("the mesh '{}' encloses nothing: it is flat", mesh.name);
  }
  return {};
}

struct GeometryCheck {
  bool is_of_world;

  std::optional<std::string> operator()(const BoxShape& box) const {
    for (const double edge : box.size_m) {
      if (auto fault = CheckSize(edge, "box's size")) return fault;
    }
    return {};
  }
  std::optional<std::string> operator()(const SphereShape& sphere) const {
    return CheckSize(sphere.radius_m, "radius");
  }
  std::optional<std::string> operator()(const CylinderShape& cylinder) const {
    if (auto fault = CheckSize(cylinder.radius_m, "radius")) return fault;
    return CheckSize(cylinder.length_m, "length");
  }
  std::optional<std::string> operator()(const CapsuleShape& capsule) const {
    if (auto fault = CheckSize(capsule.radius_m, "radius")) return fault;
    return CheckSize(capsule.length_m, "length");
  }
  std::optional<std::string> operator()(const PlaneShape&) const {
    if (is_of_world) return {};
    return "a plane has no end, so it belongs to the world and to no link";
  }
  std::optional<std::string> operator()(const MeshShape& shape) const {
    if (shape.mesh == nullptr) return "the mesh is missing";
    return CheckMesh(*shape.mesh);
  }
};

std::string NameOf(const Shape& shape, std::size_t index) {
  return shape.name.empty() ? fmt::format("shape {}", index + 1)
                            : fmt::format("shape '{}'", shape.name);
}

std::optional<std::string> CheckLimits(const Joint& joint) {
  const JointLimits& limits = joint.limits;
  if (std::isnan(limits.lower) || std::isnan(limits.upper) || limits.lower > limits.upper) {
    return fmt::format("its lower limit {} is not below its upper limit {}", limits.lower,
                       limits.upper);
  }
  const bool has_range = joint.kind == JointKind::kRevolute || joint.kind == JointKind::kPrismatic;
  if (!has_range && (limits.lower != -kNoLimit || limits.upper != kNoLimit)) {
    return "it has a range, which only revolute and prismatic joints have";
  }
  if (!(limits.effort >= 0) || !(limits.velocity >= 0)) {
    return fmt::format("its limits of effort {} and velocity {} must not be negative",
                       limits.effort, limits.velocity);
  }
  return {};
}

std::optional<std::string> CheckStart(const Joint& joint) {
  const auto check = [](const std::vector<double>& values, std::size_t count,
                        std::string_view what) -> std::optional<std::string> {
    if (values.empty()) return {};
    if (values.size() != count) {
      return fmt::format("its initial {} has {} numbers, but the joint {}", what, values.size(),
                         count);
    }
    if (!AllFinite(values)) return fmt::format("its initial {} must be finite", what);
    return {};
  };
  const std::vector<double>& position = joint.initial_position;
  if (auto fault = check(position, CoordinatesOf(joint.kind), "position")) return fault;
  if (auto fault = check(joint.initial_velocity, SpeedsOf(joint.kind), "velocity")) return fault;
  if (joint.mimic.has_value()) {
    if (position.empty() && joint.initial_velocity.empty()) return {};
    return "it has an initial position or velocity, but follows another joint";
  }
  if (joint.kind == JointKind::kFloating && !position.empty() &&
      !IsUnit({position[3], position[4], position[5], position[6]})) {
    return "its initial orientation must be a unit quaternion";
  }
  const double start = position.empty() ? 0 : position[0];
  if (start < joint.limits.lower || start > joint.limits.upper) {
    return fmt::format("its initial position {} lies beyond its limits {} and {}", start,
                       joint.limits.lower, joint.limits.upper);
  }
  return {};
}

std::optional<std::string> CheckMimic(const RobotModel& model, const Joint& joint) {
  const Mimic& mimic = *joint.mimic;
  if (CoordinatesOf(joint.kind) != 1) return "it follows another joint, but has not one coordinate";
  if (mimic.joint < 0 || static_cast<std::size_t>(mimic.joint) >= model.joints.size()) {
    return "it follows a joint that does not exist";
  }
  const Joint& leader = model.joints[static_cast<std::size_t>(mimic.joint)];
  if (&leader == &joint) return "it follows itself";
  if (CoordinatesOf(leader.kind) != 1) {
    return fmt::format("it follows joint '{}', which has not one coordinate", leader.name);
  }
  if (leader.mimic.has_value()) {
    return fmt::format("it follows joint '{}', which follows another one itself", leader.name);
  }
  if (!std::isfinite(mimic.multiplier) || !std::isfinite(mimic.offset)) {
    return "the multiplier and the offset that it follows by must be finite";
  }
  return {};
}

std::optional<std::string> CheckJointAlone(const RobotModel& model, const Joint& joint) {
  const auto is_link = [&](int link) {
    return link >= 0 && static_cast<std::size_t>(link) < model.links.size();
  };
  if (!is_link(joint.parent)) return "its parent link does not exist";
  if (!is_link(joint.child)) return "its child link does not exist";
  if (!IsPose(joint.origin)) return "its origin is no pose";
  if (joint.kind != JointKind::kFixed && joint.kind != JointKind::kFloating) {
    if (!AllFinite(joint.axis)) return "its axis must be finite";
    const auto& [x, y, z] = joint.axis;
    if (!(x * x + y * y + z * z > 1e-12)) return "its axis has no direction";
  }
  if (!IsNonNegative(joint.damping)) {
    return fmt::format("its damping must be finite and not negative, but is {}", joint.damping);
  }
  if (!IsNonNegative(joint.friction)) {
    return fmt::format("its friction must be finite and not negative, but is {}", joint.friction);
  }
  if (auto fault = CheckLimits(joint)) return fault;
  if (joint.mimic.has_value()) {
    if (auto fault = CheckMimic(model, joint)) return fault;
  }
  return CheckStart(joint);
}

Fault CheckLinks(const RobotModel& model) {
  std::unordered_set<std::string_view> names;
  for (std::size_t i = 0; i < model.links.size(); ++i) {
    const Link& link = model.links[i];
    const int index = static_cast<int>(i);
    if (!names.insert(link.name).second) {
      return ModelFault{fmt::format("two links are named '{}'", link.name), index, -1};
    }
    if (link.inertial.has_value()) {
      if (auto fault = CheckInertial(*link.inertial)) {
        return ModelFault{fmt::format("link '{}': {}", link.name, *fault), index, -1};
      }
    }
    for (std::size_t shape = 0; shape < link.shapes.size(); ++shape) {
      if (auto fault = CheckShape(link.shapes[shape], false)) {
        return ModelFault{
            fmt::format("link '{}', {}: {}", link.name, NameOf(link.shapes[shape], shape), *fault),
            index, -1};
      }
    }
  }
  return {};
}

Fault CheckJoints(const RobotModel& model) {
  std::unordered_set<std::string_view> names;
  for (std::size_t i = 0; i < model.joints.size(); ++i) {
    const Joint& joint = model.joints[i];
    const int index = static_cast<int>(i);
    if (!names.insert(joint.name).second) {
      return ModelFault{fmt::format("two joints are named '{}'", joint.name), -1, index};
    }
    if (auto fault = CheckJointAlone(model, joint)) {
      return ModelFault{fmt::format("joint '{}': {}", joint.name, *fault), -1, index};
    }
  }
  return {};
}

// Every link hangs on the root by exactly one chain of joints.
Fault CheckTree(const RobotModel& model, const std::vector<int>& joint_above) {
  const std::size_t count = model.links.size();
  std::vector<char> reaches_root(count, 0);
  std::vector<char> on_way(count, 0);
  reaches_root[static_cast<std::size_t>(model.root)] = 1;
  std::vector<std::size_t> way;
  for (std::size_t start = 0; start < count; ++start) {
    std::size_t link = start;
    way.clear();
    while (reaches_root[link] == 0) {
      const int index = static_cast<int>(link);
      if (on_way[link] != 0) {
        return ModelFault{fmt::format("the joints form a loop through link '{}', but a model is a "
                                      "tree",
                                      model.links[link].name),
                          index, joint_above[link]};
      }
      const int above = joint_above[link];
      if (above < 0) {
        return ModelFault{fmt::format("no joint joins link '{}' to the rest: link '{}' is the root",
                                      model.links[link].name,
                                      model.links[static_cast<std::size_t>(model.root)].name),
                          index, -1};
      }
      on_way[link] = 1;
      way.push_back(link);
      link = static_cast<std::size_t>(model.joints[static_cast<std::size_t>(above)].parent);
    }
    for (const std::size_t passed : way) {
      reaches_root[passed] = 1;
      on_way[passed] = 0;
    }
  }
  return {};
}

// Everything that moves has mass: each link that a joint moves, or one of the links that are fixed
// to it.
Fault CheckMasses(const RobotModel& model, const std::vector<int>& joint_above) {
  const std::size_t count = model.links.size();
  // The topmost link of the links that are fixed to each other; found once for each link.
  std::vector<int> top(count, -1);
  std::vector<std::size_t> way;
  const auto top_of = [&](std::size_t link) {
    way.clear();
    while (top[link] < 0) {
      way.push_back(link);
      const int above = joint_above[link];
      if (above < 0 || model.joints[static_cast<std::size_t>(above)].kind != JointKind::kFixed) {
        top[link] = static_cast<int>(link);
        break;
      }
      link = static_cast<std::size_t>(model.joints[static_cast<std::size_t>(above)].parent);
    }
    for (const std::size_t passed : way) top[passed] = top[link];
    return static_cast<std::size_t>(top[link]);
  };
  std::vector<char> has_mass(count, 0);
  for (std::size_t link = 0; link < count; ++link) {
    if (model.links[link].inertial.has_value()) has_mass[top_of(link)] = 1;
  }
  for (std::size_t link = 0; link < count; ++link) {
    if (top_of(link) != link || has_mass[link] != 0) continue;
    const int above = joint_above[link];
    if (above < 0 && model.has_fixed_base) continue;
    const std::string mover = above < 0
                                  ? "its base is free"
                                  : fmt::format("joint '{}' moves it",
                                                model.joints[static_cast<std::size_t>(above)].name);
    return ModelFault{fmt::format("link '{}' moves ({}) but has no mass: give it an inertial",
                                  model.links[link].name, mover),
                      static_cast<int>(link), above};
  }
  return {};
}

// Checks the inertia of each body, which is named by the first of its links that has mass.
Fault CheckInertias(const RobotModel& model) {
  const RigidTree tree = MakeTree(model);
  std::vector<char> is_named(tree.bodies.size(), 0);
  for (std::size_t i = 0; i < model.links.size(); ++i) {
    const int body = tree.links[i].body;
    if (body == kWorldBody || !model.links[i].inertial.has_value()) continue;
    const auto index = static_cast<std::size_t>(body);
    if (std::exchange(is_named[index], 1) != 0) continue;
    if (const auto fault = CheckInertia(tree.bodies[index].inertia_kgm2)) {
      return ModelFault{fmt::format("link '{}': {}", model.links[i].name, *fault),
                        static_cast<int>(i), -1};
    }
  }
  return {};
}

std::optional<std::string> CheckRotorAlone(const RobotModel& model, const Rotor& rotor) {
  if (rotor.link < 0 || rotor.link >= static_cast<int>(model.links.size())) {
    return "its link is no link of the model";
  }
  if (!IsPose(rotor.frame)) return "its frame is no pose";
  if (!IsNonNegative(rotor.thrust_ns2) || !IsNonNegative(rotor.drag_nms2)) {
    return "its thrust and its drag must be finite and not negative";
  }
  if (rotor.time_constant < VirtualDuration{}) return "its time constant is negative";
  if (!(rotor.most_radps > 0)) return "the most of its speed must be positive";
  return {};
}

Fault CheckRotors(const RobotModel& model) {
  std::unordered_set<std::string_view> names;
  for (const Rotor& rotor : model.rotors) {
    if (!names.insert(rotor.name).second) {
      return ModelFault{fmt::format("two rotors are named '{}'", rotor.name)};
    }
    if (const auto fault = CheckRotorAlone(model, rotor)) {
      return ModelFault{fmt::format("rotor '{}': {}", rotor.name, *fault)};
    }
  }
  return {};
}

Fault CheckRoot(const RobotModel& model) {
  if (model.links.empty()) return ModelFault{"the model has no link"};
  if (model.root < 0 || static_cast<std::size_t>(model.root) >= model.links.size()) {
    return ModelFault{"the model's root is none of its links"};
  }
  if (!IsPose(model.at)) return ModelFault{"the model's initial pose is no pose"};
  if (!AllFinite(model.linear_velocity_mps) || !AllFinite(model.angular_velocity_radps)) {
    return ModelFault{"the model's initial velocity must be finite"};
  }
  return {};
}

}  // namespace

std::array<double, 3> PrincipalMoments(const Inertial& inertial) {
  return PrincipalAxesOf({{{inertial.ixx_kgm2, inertial.ixy_kgm2, inertial.ixz_kgm2},
                           {inertial.ixy_kgm2, inertial.iyy_kgm2, inertial.iyz_kgm2},
                           {inertial.ixz_kgm2, inertial.iyz_kgm2, inertial.izz_kgm2}}})
      .moments;
}

std::optional<std::string> CheckShape(const Shape& shape, bool is_of_world) {
  if (auto fault = std::visit(GeometryCheck{is_of_world}, shape.geometry)) return fault;
  if (!IsPose(shape.pose)) return "its pose is no pose";
  if (!IsNonNegative(shape.friction)) {
    return fmt::format("its friction must be finite and not negative, but is {}", shape.friction);
  }
  return {};
}

std::optional<ModelFault> CheckModel(const RobotModel& model) {
  if (auto fault = CheckRoot(model)) return fault;
  if (auto fault = CheckLinks(model)) return fault;
  if (auto fault = CheckJoints(model)) return fault;
  if (auto fault = CheckRotors(model)) return fault;
  std::vector<int> joint_above(model.links.size(), -1);
  for (std::size_t i = 0; i < model.joints.size(); ++i) {
    const Joint& joint = model.joints[i];
    int& above = joint_above[static_cast<std::size_t>(joint.child)];
    const int index = static_cast<int>(i);
    if (above >= 0) {
      return ModelFault{
          fmt::format("link '{}' is the child of joint '{}' and of joint '{}', but a model is a "
                      "tree",
                      model.links[static_cast<std::size_t>(joint.child)].name,
                      model.joints[static_cast<std::size_t>(above)].name, joint.name),
          joint.child, index};
    }
    if (joint.child == model.root) {
      return ModelFault{
          fmt::format("joint '{}' has the root '{}' as its child, so the joints form "
                      "a loop",
                      joint.name, model.links[static_cast<std::size_t>(model.root)].name),
          joint.child, index};
    }
    above = index;
  }
  if (auto fault = CheckTree(model, joint_above)) return fault;
  if (auto fault = CheckMasses(model, joint_above)) return fault;
  return CheckInertias(model);
}

}  // namespace tcs
