#include "simbody_bridge/mujoco/mjcf.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

namespace tcs {
namespace {

// Friction of joints holds them: with MuJoCo's own softness a light joint creeps by half a radian a
// second. Joints' stops and mimics are as hard as steps of 1 ms bear: time constants of four steps.
// With contacts as hard as that a stack of boxes shakes itself down.
constexpr const char* kHard = "0.004 1";
constexpr const char* kContact = "0.01 1";
// A contact comes in over a fifth of a millimetre. A contact that is as hard at once throws a
// caster that is dragged off the floor, again and again, and the wheels with it.
constexpr const char* kComingIn = "0.01 0.95 0.0002";

std::string Text(const std::array<double, 3>& v) {
  return fmt::format("{:.17g} {:.17g} {:.17g}", v[0], v[1], v[2]);
}
std::string PlaceText(const Pose& pose) {
  const auto& [x, y, z, w] = pose.orientation_xyzw;
  return fmt::format("pos='{}' quat='{:.17g} {:.17g} {:.17g} {:.17g}'", Text(pose.position_m), w, x,
                     y, z);
}

class Writer {
 public:
  explicit Writer(const Forest& forest) : forest_(forest) {
    std::set<double, std::greater<>> frictions;
    for (const ForestShape& shape : forest.shapes) frictions.insert(shape.shape->friction);
    for (const double friction : frictions) {
      priority_.emplace(friction, static_cast<int>(priority_.size()));
    }
    for (const ForestShape& shape : forest.shapes) {
      has_rolls_ = has_rolls_ || std::holds_alternative<CylinderShape>(shape.shape->geometry);
    }
    children_.resize(forest.bodies.size() + 1);
    for (std::size_t i = 0; i < forest.bodies.size(); ++i) {
      children_[static_cast<std::size_t>(forest.bodies[i].parent + 1)].push_back(i);
    }
  }

  std::string Write(const std::array<double, 3>& gravity_mps2) {
    text_ = fmt::format(
        "<mujoco><compiler angle='radian' inertiafromgeom='false' balanceinertia='false'/>"
        "<option gravity='{}' integrator='RK4' cone='elliptic' impratio='100' tolerance='1e-12'>"
        "<flag multiccd='enable'/></option>"
        "<default><geom mass='0' condim='3' solref='{}' solimp='{}'/>"
        "<joint solreflimit='{}' solimplimit='0.99 0.999 0.0001' solreffriction='{}' "
        "solimpfriction='0.9999 0.9999 0.001'/></default>",
        Text(gravity_mps2), kContact, kComingIn, kHard, kHard);
    WriteMeshes();
    text_ += "<worldbody>";
    WriteShapes(kWorldBody, -1);
    WriteFixedBases();
    for (const std::size_t body : children_[0]) WriteBody(body);
    text_ += "</worldbody>";
    WriteMimics();
    WriteActuators();
    WriteExclusions();
    text_ += "</mujoco>";
    return std::move(text_);
  }

 private:
  void WriteMeshes() {
    text_ += "<asset>";
    for (const ForestShape& shape : forest_.shapes) {
      const auto* mesh = std::get_if<MeshShape>(&shape.shape->geometry);
      if (mesh == nullptr) continue;
      const auto [known, is_new] = meshes_.try_emplace(mesh->mesh.get(), meshes_.size());
      if (!is_new) continue;
      text_ += fmt::format("<mesh name='m{}' vertex='", known->second);
      for (const auto& vertex : mesh->mesh->vertices_m) text_ += Text(vertex) + ' ';
      text_ += "'/>";
    }
    text_ += "</asset>";
  }

  // The part of a model that is fixed to the world is a body of its own, so that bodies that are
  // joined to it can be told not to collide with it.
  void WriteFixedBases() {
    const int models = static_cast<int>(forest_.has_self_collision.size());
    for (int model = 0; model < models; ++model) {
      text_ += fmt::format("<body name='w{}'>", model);
      WriteShapes(kWorldBody, model);
      text_ += "</body>";
    }
  }

  void WriteBody(std::size_t index) {
    const TreeBody& body = forest_.bodies[index];
    Matrix3 i = body.inertia_kgm2;
    // MuJoCo takes no smaller eigenvalues of a whole matrix.
    constexpr double kLeast = 1e-14;
    const bool is_diagonal = i[0][1] == 0 && i[0][2] == 0 && i[1][2] == 0;
    const bool is_tiny = i[0][0] + i[1][1] + i[2][2] < 100 * kLeast;
    if (is_tiny && !is_diagonal) {
      for (std::size_t k = 0; k < 3; ++k) i[k][k] += kLeast;
    }
    text_ += fmt::format("<body name='b{}' {}>", index, PlaceText(body.origin));
    WriteJoints(index, body);
    if (is_tiny && is_diagonal) {
      text_ +=
          fmt::format("<inertial pos='{}' mass='{:.17g}' diaginertia='{:.17g} {:.17g} {:.17g}'/>",
                      Text(body.center_m), body.mass_kg, i[0][0], i[1][1], i[2][2]);
    } else {
      text_ += fmt::format(
          "<inertial pos='{}' mass='{:.17g}' fullinertia='{:.17g} {:.17g} {:.17g} {:.17g} {:.17g} "
          "{:.17g}'/>",
          Text(body.center_m), body.mass_kg, i[0][0], i[1][1], i[2][2], i[0][1], i[0][2], i[1][2]);
    }
    WriteShapes(static_cast<int>(index), forest_.model_of_body[index]);
    text_ += fmt::format("<site name='b{}'/>", index);
    for (const std::size_t child : children_[index + 1]) WriteBody(child);
    text_ += "</body>";
  }

  void WriteJoints(std::size_t index, const TreeBody& body) {
    const std::string name = fmt::format("b{}", index);
    switch (body.kind) {
      case JointKind::kRevolute:
      case JointKind::kContinuous:
        WriteJoint(name, "hinge", body, body.axis);
        return;
      case JointKind::kPrismatic:
        WriteJoint(name, "slide", body, body.axis);
        return;
      case JointKind::kPlanar:
        WriteJoint(name + "x", "slide", body, Rotate(FromZTo(body.axis), {1, 0, 0}));
        WriteJoint(name + "y", "slide", body, Rotate(FromZTo(body.axis), {0, 1, 0}));
        WriteJoint(name, "hinge", body, body.axis);
        return;
      case JointKind::kFloating:
      case JointKind::kFixed:  // never: a forest has none
        if (HasFreeJoint(body)) {
          text_ += fmt::format("<freejoint name='{}'/>", name);
          return;
        }
        WriteJoint(name + "x", "slide", body, {1, 0, 0});
        WriteJoint(name + "y", "slide", body, {0, 1, 0});
        WriteJoint(name + "z", "slide", body, {0, 0, 1});
        WriteJoint(name, "ball", body, {0, 0, 1});
        return;
    }
  }

  void WriteJoint(const std::string& name, const char* type, const TreeBody& body,
                  const std::array<double, 3>& axis) {
    const Joint& joint = *forest_.joints[static_cast<std::size_t>(body.joint)].joint;
    text_ += fmt::format("<joint name='{}' type='{}' axis='{}' damping='{:.17g}'", name, type,
                         Text(axis), joint.damping);
    if (joint.friction > 0) text_ += fmt::format(" frictionloss='{:.17g}'", joint.friction);
    const JointLimits& limits = joint.limits;
    if (limits.lower != -kNoLimit || limits.upper != kNoLimit) {
      // MuJoCo knows ranges only, not one end without the other, and none that is a point.
      constexpr double kFar = 1e9, kNarrow = 1e-9;
      const double lower = std::max(limits.lower, -kFar), upper = std::min(limits.upper, kFar);
      const double missing =
          std::max(0.0, kNarrow * std::max(1.0, std::abs(lower)) - (upper - lower));
      text_ += fmt::format(" limited='true' range='{:.17g} {:.17g}'", lower - missing / 2,
                           upper + missing / 2);
    }
    text_ += "/>";
  }

  void WriteShapes(int body, int model) {
    for (std::size_t i = 0; i < forest_.shapes.size(); ++i) {
      const ForestShape& shape = forest_.shapes[i];
      if (shape.body != body || shape.model != model) continue;
      // Of two geoms that touch the friction of the one with the higher priority acts: the smaller.
      const Geometry& geometry = shape.shape->geometry;
      const std::string rest =
          fmt::format("{} friction='{:.17g} 0.005 0.0001' priority='{}'/>", PlaceText(shape.pose),
                      shape.shape->friction, priority_.at(shape.shape->friction));
      const bool is_flat = std::holds_alternative<PlaneShape>(geometry) ||
                           std::holds_alternative<BoxShape>(geometry);
      text_ += fmt::format("<geom name='s{}' {} {}{}", i, TextOf(geometry),
                           has_rolls_ && is_flat ? "contype='3' " : "", rest);
      // MuJoCo has a cylinder touch by its rims; a wheel would turn round one of these, as if the
      // wheels were nearer to each other by their width. Flat shapes meet the cylinder's middle,
      // too.
      if (const auto* cylinder = std::get_if<CylinderShape>(&geometry)) {
        constexpr double kMiddle = 0.1;
        text_ += fmt::format(
            "<geom name='d{}' type='cylinder' size='{:.17g} {:.17g}' contype='0' conaffinity='2' "
            "{}",
            i, cylinder->radius_m, kMiddle * cylinder->length_m / 2, rest);
      }
    }
  }

  std::string TextOf(const Geometry& geometry) const {
    if (const auto* box = std::get_if<BoxShape>(&geometry)) {
      const auto& [x, y, z] = box->size_m;
      return fmt::format("type='box' size='{}'", Text({x / 2, y / 2, z / 2}));
    }
    if (const auto* sphere = std::get_if<SphereShape>(&geometry)) {
      return fmt::format("type='sphere' size='{:.17g}'", sphere->radius_m);
    }
    if (const auto* cylinder = std::get_if<CylinderShape>(&geometry)) {
      return fmt::format("type='cylinder' size='{:.17g} {:.17g}'", cylinder->radius_m,
                         cylinder->length_m / 2);
    }
    if (const auto* capsule = std::get_if<CapsuleShape>(&geometry)) {
      return fmt::format("type='capsule' size='{:.17g} {:.17g}'", capsule->radius_m,
                         capsule->length_m / 2);
    }
    if (const auto* mesh = std::get_if<MeshShape>(&geometry)) {
      return fmt::format("type='mesh' mesh='m{}'", meshes_.at(mesh->mesh.get()));
    }
    return "type='plane' size='0 0 1'";
  }

  void WriteMimics() {
    text_ += "<equality>";
    for (const ForestJoint& joint : forest_.joints) {
      if (joint.leader < 0) continue;
      const Mimic& mimic = *joint.joint->mimic;
      text_ += fmt::format(
          "<joint joint1='b{}' joint2='b{}' polycoef='{:.17g} {:.17g} 0 0 0' solref='{}' "
          "solimp='0.99 0.999 0.0001'/>",
          joint.body, forest_.joints[static_cast<std::size_t>(joint.leader)].body, mimic.offset,
          mimic.multiplier, kHard);
    }
    text_ += "</equality>";
  }

  void WriteActuators() {
    text_ += "<actuator>";
    for (std::size_t i = 0; i < forest_.bodies.size(); ++i) {
      text_ += fmt::format("<general name='b{0}' site='b{0}' gear='0 0 0 0 0 0'/>", i);
    }
    for (std::size_t i = 0; i < forest_.joints.size(); ++i) {
      if (!IsDriven(forest_, i)) continue;
      const double limit = forest_.joints[i].joint->limits.effort;
      text_ += fmt::format("<general name='j{}' joint='b{}' biastype='affine'", i,
                           forest_.joints[i].body);
      if (limit != kNoLimit && limit > 0) {
        text_ += fmt::format(" forcelimited='true' forcerange='{:.17g} {:.17g}'", -limit, limit);
      }
      text_ += "/>";
    }
    text_ += "</actuator>";
  }

  // MuJoCo leaves out pairs of bodies only. Where some links of two bodies are to pass through each
  // other and others not, the others are paired by name.
  void WriteExclusions() {
    text_ += "<contact>";
    std::set<std::pair<int, int>> apart;  // bodies
    for (const auto& pair : forest_.ignored_pairs) PairWhatTouches(pair, &apart);
    const int bodies = static_cast<int>(forest_.bodies.size());
    for (int a = 0; a < bodies; ++a) {
      const int model = forest_.model_of_body[static_cast<std::size_t>(a)];
      if (apart.contains({kWorldBody, a}) ||
          !MayTouch(forest_, {nullptr, a, {}, model}, {nullptr, kWorldBody, {}, model})) {
        text_ += fmt::format("<exclude body1='b{}' body2='w{}'/>", a, model);
      }
      for (int b = a + 1; b < bodies; ++b) {
        const int other = forest_.model_of_body[static_cast<std::size_t>(b)];
        if (!apart.contains({a, b}) &&
            MayTouch(forest_, {nullptr, a, {}, model}, {nullptr, b, {}, other})) {
          continue;
        }
        text_ += fmt::format("<exclude body1='b{}' body2='b{}'/>", a, b);
      }
    }
    text_ += "</contact>";
  }

  // Pairs the shapes that touch, of the bodies of two links; the bodies become known to be apart.
  void PairWhatTouches(const std::pair<int, int>& links, std::set<std::pair<int, int>>* apart) {
    const auto first = std::ranges::find(forest_.shapes, links.first, &ForestShape::link);
    const auto second = std::ranges::find(forest_.shapes, links.second, &ForestShape::link);
    if (first == forest_.shapes.end() || second == forest_.shapes.end()) return;  // no shapes
    const int model = first->model;
    const std::pair<int, int> bodies = std::minmax(first->body, second->body);
    if (bodies.first == bodies.second || !apart->insert(bodies).second) return;
    for (std::size_t i = 0; i < forest_.shapes.size(); ++i) {
      for (std::size_t k = 0; k < forest_.shapes.size(); ++k) {
        const ForestShape &a = forest_.shapes[i], &b = forest_.shapes[k];
        if (a.body != bodies.first || b.body != bodies.second || a.model != model ||
            b.model != model || !MayTouch(forest_, a, b)) {
          continue;
        }
        const double friction = std::min(a.shape->friction, b.shape->friction);
        text_ += fmt::format(
            "<pair geom1='s{0}' geom2='s{1}' condim='3' friction='{2:.17g} {2:.17g} 0.005 0.0001 "
            "0.0001' solref='{3}' solimp='{4}'/>",
            i, k, friction, kContact, kComingIn);
      }
    }
  }

  const Forest& forest_;
  bool has_rolls_ = false;                          // cylinders
  std::map<double, int> priority_;                  // of each friction
  std::vector<std::vector<std::size_t>> children_;  // of the world, then of each body
  std::map<const Mesh*, std::size_t> meshes_;
  std::string text_;
};

}  // namespace

bool IsDriven(const Forest& forest, std::size_t joint) {
  const ForestJoint& of = forest.joints[joint];
  return of.leader < 0 && CoordinatesOf(of.joint->kind) == 1;
}

bool HasFreeJoint(const TreeBody& body) { return body.parent == kWorldBody && body.joint < 0; }

std::string MjcfOf(const Forest& forest, const std::array<double, 3>& gravity_mps2) {
  return Writer(forest).Write(gravity_mps2);
}

}  // namespace tcs
