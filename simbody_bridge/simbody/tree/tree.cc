#include "simbody_bridge/simbody/tree/tree.h"

#include <algorithm>
#include <cstring>
#include <limits>

#include "simbody_bridge/joints/branches.h"
#include "simbody_bridge/model/vectors.h"
#include "simbody_bridge/simbody/tree/link_force.h"
#include "simbody_bridge/simbody/tree/mimics.h"
#include "simbody_bridge/simbody/vectors.h"

namespace tcs {
namespace {

SimTK::MassProperties MassOf(const TreeBody& body) {
  const Matrix3& i = body.inertia_kgm2;
  const SimTK::Inertia central(i[0][0], i[1][1], i[2][2], i[0][1], i[0][2], i[1][2]);
  const SimTK::Vec3 center = ToVec3(body.center_m);
  return {body.mass_kg, center, central.shiftFromMassCenter(-center, body.mass_kg)};
}

// The joint's axis is the z of Simbody's frames, or of a slider's the x. A floating joint has none,
// which turns nothing.
SimTK::Rotation FrameOf(const TreeBody& body) {
  const SimTK::Rotation z_on_axis = ToRotation(FromZTo(body.axis));
  if (body.kind != JointKind::kPrismatic) return z_on_axis;
  return z_on_axis * SimTK::Rotation(-SimTK::Pi / 2, SimTK::YAxis);  // takes x to z
}

}  // namespace

SimbodyTree::SimbodyTree(const Forest& forest, const std::array<double, 3>& gravity_mps2)
    : forest_(forest) {
  forces_.setNumberOfThreads(1);
  if (gravity_mps2 != std::array<double, 3>{}) {
    SimTK::Force::UniformGravity(forces_, matter_, ToVec3(gravity_mps2));
  }
  for (const TreeBody& body : forest.bodies) AddBody(body);
  // Simbody owns the forces.
  SimTK::Force::Custom(forces_, new LinkForce(forest_, bodies_, acting_));
  auto* joints = new JointForce(forest_, bodies_, acting_);
  SimTK::Force::Custom(forces_, joints);
  state_ = system_.realizeTopology();
  system_.realizeModel(state_);
  SetStart();
  if (std::ranges::any_of(forest.joints, [](const ForestJoint& of) { return of.leader >= 0; })) {
    reduced_count_ = Reduce(*this, &reduced_);
  }
  joints->Measure(matter_, state_);
  joint_force_ = joints;
  contacts_ = std::make_unique<Contacts>(forest_, bodies_);
}

void SimbodyTree::AddBody(const TreeBody& body) {
  SimTK::MobilizedBody parent = matter_.Ground();
  if (body.parent != kWorldBody) parent = bodies_[static_cast<std::size_t>(body.parent)];
  const SimTK::Body::Rigid mass(MassOf(body));
  const SimTK::Transform turned(FrameOf(body));
  const SimTK::Transform on_parent = ToTransform(body.origin) * turned;
  switch (body.kind) {
    case JointKind::kRevolute:
    case JointKind::kContinuous:
      bodies_.push_back(SimTK::MobilizedBody::Pin(parent, on_parent, mass, turned));
      return;
    case JointKind::kPrismatic:
      bodies_.push_back(SimTK::MobilizedBody::Slider(parent, on_parent, mass, turned));
      return;
    case JointKind::kPlanar:
      bodies_.push_back(SimTK::MobilizedBody::Planar(parent, on_parent, mass, turned));
      return;
    case JointKind::kFloating:
    case JointKind::kFixed:  // never: a forest has none
      bodies_.push_back(SimTK::MobilizedBody::Free(parent, on_parent, mass, turned));
      return;
  }
}

// Of a planar joint Simbody has the angle first; of a floating one the quaternion w x y z before
// the position, and the angular velocity before the linear one.
void SimbodyTree::SetStart() {
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const TreeBody& body = forest_.bodies[i];
    const SimTK::MobilizedBody& mobile = bodies_[i];
    SimTK::Vector q = mobile.getQAsVector(state_), u = mobile.getUAsVector(state_);
    const std::vector<double>& at = body.position;
    const std::vector<double>& speed = body.velocity;
    if (body.kind == JointKind::kFloating) {
      const auto xyzw = Normalised({at[3], at[4], at[5], at[6]});
      q(0) = xyzw[3];
      for (int k = 0; k < 3; ++k) {
        const auto from = static_cast<std::size_t>(k);
        q(1 + k) = xyzw[from];
        q(4 + k) = at[from];
        u(k) = speed[from + 3];
        u(3 + k) = speed[from];
      }
    } else {
      const int count = q.size();
      for (int k = 0; k < count; ++k) {
        const auto to = count == 3 ? (k + 1) % 3 : k;
        q(to) = at[static_cast<std::size_t>(k)];
        u(to) = speed[static_cast<std::size_t>(k)];
      }
    }
    mobile.setQFromVector(state_, q);
    mobile.setUFromVector(state_, u);
    const auto all = static_cast<std::size_t>(state_.getNQ());
    slots_.push_back({static_cast<std::size_t>(mobile.getFirstQIndex(state_)),
                      static_cast<std::size_t>(q.size()),
                      all + static_cast<std::size_t>(mobile.getFirstUIndex(state_)),
                      static_cast<std::size_t>(u.size())});
  }
  const SimTK::Vector& y = state_.getY();
  start_.assign(y.getContiguousScalarData(), y.getContiguousScalarData() + y.size());
}

// Results of a state that is loaded already are kept, but for those on which the commands act.
void SimbodyTree::Load(std::span<const double> state) {
  if (state.empty()) return;
  const double* loaded = state_.getY().getContiguousScalarData();
  if (is_loaded_ && std::memcmp(loaded, state.data(), state.size_bytes()) == 0) return;
  state_.updTime() = 0;
  std::copy(state.begin(), state.end(), &state_.updY()[0]);
  is_loaded_ = true;
  has_mass_ = false;
}

void SimbodyTree::Evaluate(std::span<const double> state, std::span<const Wrench> acting,
                           double* rate) {
  try {
    acting_ = acting;
    Load(state);
    state_.invalidateAll(SimTK::Stage::Dynamics);
    system_.realize(state_, SimTK::Stage::Acceleration);
    std::copy_n(state_.getYDot().getContiguousScalarData(), state.size(), rate);
    if (!reduced_.empty()) TieToLeaders(rate + state_.getNQ());
  } catch (const std::exception&) {
    std::fill_n(rate, state.size(), std::numeric_limits<double>::quiet_NaN());
  }
}

// Joints that mimic others are no constraints of Simbody's: constraints took two fifths of a step.
// The forces on all joints (the mass matrix times their rates) and the mass matrix are reduced to
// the joints that mimic no other, whose rates give those of all.
void SimbodyTree::TieToLeaders(double* rates) {
  if (!has_mass_) ComputeMass();
  Eigen::Map<Eigen::VectorXd> all(rates, mass_.rows());
  Eigen::VectorXd tied;
  ReduceSystem(reduced_, reduced_count_, mass_, mass_ * all, &tied_mass_, &tied);
  SolveByBranches(&tied_mass_, &tied);
  all = SpreadToAll(reduced_, tied);
}

void SimbodyTree::EvaluateOrRecall(std::span<const double> state, std::span<const Wrench> acting,
                                   double* rate) {
  const bool is_known =
      recalled_.state.size() == state.size() &&
      std::memcmp(recalled_.state.data(), state.data(), state.size_bytes()) == 0 &&
      std::equal(acting.begin(), acting.end(), recalled_.acting.begin(), recalled_.acting.end());
  if (!is_known) {
    recalled_.rate.resize(state.size());
    Evaluate(state, acting, recalled_.rate.data());
    recalled_.state.assign(state.begin(), state.end());
    recalled_.acting.assign(acting.begin(), acting.end());
  }
  std::copy(recalled_.rate.begin(), recalled_.rate.end(), rate);
}

void SimbodyTree::CoordinateRates(std::span<const double> state, std::span<const double> speeds,
                                  std::span<double> rates) const {
  for (std::size_t i = 0; i < slots_.size(); ++i) {
    const StateSlots& slots = slots_[i];
    const double* of_body = &speeds[slots.u - static_cast<std::size_t>(state_.getNQ())];
    double* into = &rates[slots.q];
    if (forest_.bodies[i].kind == JointKind::kFloating) {
      const SimTK::Vec4 wxyz = SimTK::Vec4::getAs(&state[slots.q]);
      SimTK::Vec4::updAs(into) =
          SimTK::Rotation::calcUnnormalizedNForQuaternion(wxyz) * SimTK::Vec3::getAs(of_body);
      into += 4, of_body += 3;
      std::copy_n(of_body, 3, into);
    } else {
      std::copy_n(of_body, slots.u_count, into);
    }
  }
}

void SimbodyTree::Linearise(std::span<const double> state, std::span<const Wrench> acting,
                            Eigen::MatrixXd* mass, std::vector<double>* by_speed,
                            std::vector<double>* by_coordinate) {
  acting_ = acting;
  FindMass(state, mass);
  joint_force_->Slopes(state_, by_speed, by_coordinate);
}

void SimbodyTree::FindMass(std::span<const double> state, Eigen::MatrixXd* mass) {
  Load(state);
  system_.realize(state_, SimTK::Stage::Position);
  FindMass(mass);
}

void SimbodyTree::FindMass(Eigen::MatrixXd* mass) {
  if (!has_mass_) ComputeMass();
  *mass = mass_;
}

// By composite rigid bodies (Featherstone, Rigid Body Dynamics Algorithms, 2008, chapter 6), in the
// number of speeds times the depth of the tree: Simbody's calcM multiplies by the matrix as often
// as it has columns.
void SimbodyTree::ComputeMass() {
  const int all = state_.getNU(), coordinates = state_.getNQ();
  mass_.setZero(all, all);
  if (bodies_.size() == 1) {
    SimTK::Matrix of_one;
    matter_.calcM(state_, of_one);
    for (int i = 0; i < all; ++i) {
      for (int k = 0; k < all; ++k) mass_(i, k) = of_one(i, k);
    }
    has_mass_ = true;
    return;
  }
  matter_.realizeCompositeBodyInertias(state_);
  FindJointAxes();
  const auto first_of = [&](std::size_t body) {
    return static_cast<int>(slots_[body].u) - coordinates;
  };
  for (std::size_t body = 0; body < bodies_.size(); ++body) {
    const SimTK::SpatialInertia& composite =
        matter_.getCompositeBodyInertia(state_, bodies_[body].getMobilizedBodyIndex());
    for (int k = 0; k < static_cast<int>(slots_[body].u_count); ++k) {
      const int column = first_of(body) + k;
      SimTK::SpatialVec force = composite * joint_axes_[static_cast<std::size_t>(column)];
      for (std::size_t at = body;;) {
        const int first = first_of(at);
        const int count = at == body ? k + 1 : static_cast<int>(slots_[at].u_count);
        for (int row = first; row < first + count; ++row) {
          const SimTK::SpatialVec& axis = joint_axes_[static_cast<std::size_t>(row)];
          mass_(row, column) = mass_(column, row) = dot(axis[0], force[0]) + dot(axis[1], force[1]);
        }
        const int parent = forest_.bodies[at].parent;
        if (parent == kWorldBody) break;
        const auto next = static_cast<std::size_t>(parent);
        const SimTK::Vec3 arm =
            bodies_[at].getBodyOriginLocation(state_) - bodies_[next].getBodyOriginLocation(state_);
        force[0] += arm % force[1];
        at = next;
      }
    }
  }
  has_mass_ = true;
}

void SimbodyTree::FindJointAxes() {
  joint_axes_.resize(static_cast<std::size_t>(state_.getNU()));
  const auto coordinates = static_cast<std::size_t>(state_.getNQ());
  for (std::size_t body = 0; body < bodies_.size(); ++body) {
    for (std::size_t k = 0; k < slots_[body].u_count; ++k) {
      joint_axes_[slots_[body].u - coordinates + k] =
          bodies_[body].getHCol(state_, SimTK::MobilizerUIndex(static_cast<int>(k)));
    }
  }
}

void SimbodyTree::NormaliseQuaternions(std::span<double> state) const {
  for (std::size_t i = 0; i < slots_.size(); ++i) {
    if (forest_.bodies[i].kind != JointKind::kFloating) continue;
    Normalise(state.subspan(slots_[i].q).first<4>());
  }
}

void SimbodyTree::Project(std::span<double> state) {
  NormaliseQuaternions(state);
  if (reduced_.empty()) return;
  for (const ForestJoint& follower : forest_.joints) {
    if (follower.leader < 0) continue;
    const Mimic& mimic = *follower.joint->mimic;
    const ForestJoint& leader = forest_.joints[static_cast<std::size_t>(follower.leader)];
    const StateSlots& from = slots_[static_cast<std::size_t>(leader.body)];
    const StateSlots& to = slots_[static_cast<std::size_t>(follower.body)];
    state[to.q] = mimic.multiplier * state[from.q] + mimic.offset;
    state[to.u] = mimic.multiplier * state[from.u];
  }
}

double SimbodyTree::LongestStepFrom(std::span<const double> state) const {
  double longest_s = std::numeric_limits<double>::infinity();
  for (const ForestJoint& joint : forest_.joints) {
    if (joint.body == kWorldBody) continue;
    const StateSlots& slots = slots_[static_cast<std::size_t>(joint.body)];
    longest_s = std::min(longest_s, TimeToStop(*joint.joint, state[slots.q], state[slots.u]));
  }
  return longest_s;
}

double SimbodyTree::TimeToTouch(std::span<const double> state) {
  if (!contacts_->has_pairs()) return std::numeric_limits<double>::infinity();
  Load(state);
  system_.realize(state_, SimTK::Stage::Velocity);
  return contacts_->TimeToTouch(state_);
}

bool SimbodyTree::MayHaveTouched(std::span<const double> state, double seconds) {
  if (!contacts_->has_pairs()) return false;
  Load(state);
  system_.realize(state_, SimTK::Stage::Velocity);
  return contacts_->MayHaveTouched(state_, seconds);
}

bool SimbodyTree::MayComeDeeper(std::span<const double> state, double seconds, double depth_m) {
  if (!contacts_->has_pairs()) return false;
  Load(state);
  system_.realize(state_, SimTK::Stage::Velocity);
  return contacts_->MayComeDeeper(state_, seconds, depth_m);
}

double SimbodyTree::LatenessOfTouch(std::span<const double> state, double late_m, double met_m) {
  Load(state);
  system_.realize(state_, SimTK::Stage::Velocity);
  return contacts_->LatenessOfTouch(state_, late_m, met_m);
}

void SimbodyTree::CopyBody(std::size_t body, std::span<const double> state, const SimbodyTree& to,
                           std::size_t to_body, std::span<double> into) const {
  const StateSlots &from = slots_[body], &at = to.slots_[to_body];
  std::copy_n(&state[from.q], from.q_count, &into[at.q]);
  std::copy_n(&state[from.u], from.u_count, &into[at.u]);
}

void SimbodyTree::ReadLinks(std::span<const double> state, std::span<const int> links,
                            std::span<LinkState> read) {
  Load(state);
  system_.realize(state_, SimTK::Stage::Velocity);
  for (std::size_t i = 0; i < links.size(); ++i) {
    const TreeLink& link = forest_.links[static_cast<std::size_t>(links[i])];
    LinkState& of_link = read[i];
    if (link.body == kWorldBody) {
      of_link = {link.pose, {}, {}};
      continue;
    }
    const SimTK::MobilizedBody& body = bodies_[static_cast<std::size_t>(link.body)];
    const SimTK::Transform pose = body.getBodyTransform(state_) * ToTransform(link.pose);
    of_link.pose = {ToArray(pose.p()), ToXyzw(pose.R())};
    of_link.linear_velocity_mps =
        ToArray(body.findStationVelocityInGround(state_, ToVec3(link.pose.position_m)));
    of_link.angular_velocity_radps = ToArray(body.getBodyAngularVelocity(state_));
  }
}

void SimbodyTree::ReadJoints(std::span<const double> state, std::span<const Wrench> acting,
                             std::span<const int> joints, std::span<JointState> read) const {
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const auto index = static_cast<std::size_t>(joints[i]);
    const ForestJoint& joint = forest_.joints[index];
    if (joint.body == kWorldBody) {
      read[i] = {};
      continue;
    }
    const StateSlots& slots = slots_[static_cast<std::size_t>(joint.body)];
    const double q = state[slots.q], u = state[slots.u];
    const JointDrive drive = DriveOfJoint(acting, forest_.links.size(), index);
    read[i] = {q, u, EffortOf(drive, joint.joint->limits.effort, q, u)};
  }
}

}  // namespace tcs
