#include "simbody_bridge/model/rigid_tree.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "simbody_bridge/model/principal_axes.h"
#include "simbody_bridge/model/vectors.h"

namespace tcs {
namespace {

using Vector = std::array<double, 3>;

Matrix3 MatrixOf(const std::array<double, 4>& q) {
  const Vector x = Rotate(q, {1, 0, 0}), y = Rotate(q, {0, 1, 0}), z = Rotate(q, {0, 0, 1});
  return {{{x[0], y[0], z[0]}, {x[1], y[1], z[1]}, {x[2], y[2], z[2]}}};
}

// The inertia of `inertial` along the axes of a frame in which the link is turned by `q`.
Matrix3 Turned(const Inertial& inertial, const std::array<double, 4>& q) {
  const Matrix3 r = MatrixOf(Times(q, inertial.frame.orientation_xyzw));
  const Matrix3 i = {{{inertial.ixx_kgm2, inertial.ixy_kgm2, inertial.ixz_kgm2},
                      {inertial.ixy_kgm2, inertial.iyy_kgm2, inertial.iyz_kgm2},
                      {inertial.ixz_kgm2, inertial.iyz_kgm2, inertial.izz_kgm2}}};
  Matrix3 turned{};
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t column = 0; column < 3; ++column) {
      for (std::size_t k = 0; k < 3; ++k) {
        for (std::size_t l = 0; l < 3; ++l) {
          turned[row][column] += r[row][k] * i[k][l] * r[column][l];
        }
      }
    }
  }
  return turned;
}

// Adds a mass at `offset` from the origin to an inertia about the origin.
void AddPointMass(double mass_kg, const Vector& offset, Matrix3* inertia) {
  const double square = Dot(offset, offset);
  for (std::size_t i = 0; i < 3; ++i) {
    (*inertia)[i][i] += mass_kg * square;
    for (std::size_t k = 0; k < 3; ++k) (*inertia)[i][k] -= mass_kg * offset[i] * offset[k];
  }
}

// Puts `inertial` of a link at `pose` into the body, which keeps its inertia about its center.
void AddMass(const Inertial& inertial, const Pose& pose, TreeBody* body) {
  const Vector center = Times(pose, inertial.frame).position_m;
  const double before_kg = body->mass_kg, mass_kg = before_kg + inertial.mass_kg;
  Vector common;
  for (std::size_t i = 0; i < 3; ++i) {
    common[i] = (before_kg * body->center_m[i] + inertial.mass_kg * center[i]) / mass_kg;
  }
  const Matrix3 own = Turned(inertial, pose.orientation_xyzw);
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) body->inertia_kgm2[i][k] += own[i][k];
  }
  if (before_kg > 0) {
    AddPointMass(before_kg, Minus(body->center_m, common), &body->inertia_kgm2);
    AddPointMass(inertial.mass_kg, Minus(center, common), &body->inertia_kgm2);
  }
  body->mass_kg = mass_kg;
  body->center_m = common;
}

// Adds the same amount to all three moments.
void MakePossible(Matrix3* inertia) {
  constexpr double kLeast = 1e-15, kSlack = 1e-9;
  const std::array<double, 3> moments = PrincipalAxesOf(*inertia).moments;
  const double beyond = moments[2] - moments[0] - moments[1];
  double missing = std::max(0.0, kLeast * (1 + kSlack) - moments[0]);
  if (beyond > -kSlack / 2 * moments[2]) missing = std::max(missing, beyond + kSlack * moments[2]);
  for (std::size_t i = 0; i < 3; ++i) (*inertia)[i][i] += missing;
}

Vector Unit(const Vector& v) {
  const double norm = std::sqrt(Dot(v, v));
  return {v[0] / norm, v[1] / norm, v[2] / norm};
}

std::vector<double> Filled(const std::vector<double>& given, std::size_t count) {
  if (!given.empty()) return given;
  std::vector<double> filled(count);
  if (count == 7) filled[6] = 1;  // no rotation
  return filled;
}

void SetStart(const RobotModel& model, const Joint& joint, TreeBody* body) {
  if (!joint.mimic.has_value()) {
    body->position = Filled(joint.initial_position, CoordinatesOf(joint.kind));
    body->velocity = Filled(joint.initial_velocity, SpeedsOf(joint.kind));
    return;
  }
  const Mimic& mimic = *joint.mimic;
  const Joint& leader = model.joints[static_cast<std::size_t>(mimic.joint)];
  body->position = {mimic.multiplier * Filled(leader.initial_position, 1)[0] + mimic.offset};
  body->velocity = {mimic.multiplier * Filled(leader.initial_velocity, 1)[0]};
}

TreeBody FreeBase(const RobotModel& model) {
  const auto& p = model.at.position_m;
  const auto q = Normalised(model.at.orientation_xyzw);
  const auto& v = model.linear_velocity_mps;
  const auto& w = model.angular_velocity_radps;
  TreeBody body;
  body.position = {p[0], p[1], p[2], q[0], q[1], q[2], q[3]};
  body.velocity = {v[0], v[1], v[2], w[0], w[1], w[2]};
  return body;
}

TreeBody BodyOf(const RobotModel& model, int index, const TreeLink& parent) {
  const Joint& joint = model.joints[static_cast<std::size_t>(index)];
  TreeBody body;
  body.parent = parent.body;
  body.joint = index;
  body.kind = joint.kind;
  body.origin = Times(parent.pose, joint.origin);
  if (joint.kind != JointKind::kFloating) body.axis = Unit(joint.axis);
  SetStart(model, joint, &body);
  return body;
}

// The joints of the root first, then those of its children and of theirs; the joints of one link in
// the order of the model's joints.
std::vector<int> JointsFromRoot(const RobotModel& model) {
  std::vector<std::vector<int>> below(model.links.size());
  for (std::size_t i = 0; i < model.joints.size(); ++i) {
    below[static_cast<std::size_t>(model.joints[i].parent)].push_back(static_cast<int>(i));
  }
  std::vector<int> order = below[static_cast<std::size_t>(model.root)];
  for (std::size_t next = 0; next < order.size(); ++next) {
    const int child = model.joints[static_cast<std::size_t>(order[next])].child;
    // Joints are added one by one: GCC 14 believes that insert() writes beyond the end.
    for (const int joint : below[static_cast<std::size_t>(child)]) order.push_back(joint);
  }
  return order;
}

}  // namespace

std::array<double, 4> FromZTo(const std::array<double, 3>& axis) {
  const auto& [x, y, z] = axis;
  if (z < -1 + 1e-12) return {1, 0, 0, 0};  // half a turn about x
  return Normalised({-y, x, 0, 1 + z});
}

RigidTree MakeTree(const RobotModel& model) {
  RigidTree tree;
  tree.links.resize(model.links.size());
  tree.body_of_joint.assign(model.joints.size(), kWorldBody);
  TreeLink& root = tree.links[static_cast<std::size_t>(model.root)];
  if (model.has_fixed_base) {
    root.pose = {model.at.position_m, Normalised(model.at.orientation_xyzw)};
  } else {
    tree.bodies.push_back(FreeBase(model));
    root.body = 0;
  }
  for (const int index : JointsFromRoot(model)) {
    const Joint& joint = model.joints[static_cast<std::size_t>(index)];
    const TreeLink& parent = tree.links[static_cast<std::size_t>(joint.parent)];
    TreeLink& child = tree.links[static_cast<std::size_t>(joint.child)];
    if (joint.kind == JointKind::kFixed) {
      child = {parent.body, Times(parent.pose, joint.origin)};
      continue;
    }
    child.body = static_cast<int>(tree.bodies.size());
    tree.body_of_joint[static_cast<std::size_t>(index)] = child.body;
    tree.bodies.push_back(BodyOf(model, index, parent));
  }
  for (std::size_t i = 0; i < model.links.size(); ++i) {
    const TreeLink& link = tree.links[i];
    if (link.body == kWorldBody || !model.links[i].inertial.has_value()) continue;
    AddMass(*model.links[i].inertial, link.pose, &tree.bodies[static_cast<std::size_t>(link.body)]);
  }
  return tree;
}

void MakePossible(RigidTree* tree) {
  for (TreeBody& body : tree->bodies) MakePossible(&body.inertia_kgm2);
}

}  // namespace tcs
