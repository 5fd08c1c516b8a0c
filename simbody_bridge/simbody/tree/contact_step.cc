#include "simbody_bridge/simbody/tree/contact_step.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "simbody_bridge/joints/branches.h"
#include "simbody_bridge/joints/dry_friction.h"
#include "simbody_bridge/joints/joint_groups.h"
#include "simbody_bridge/simbody/tree/mimics.h"
#include "simbody_bridge/simbody/vectors.h"
#include "simbody_bridge/whole_nanoseconds.h"

namespace tcs {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr int kRounds = 6;
// Slower than this a contact sticks: it creeps in proportion to the push on it.
constexpr double kStickMps = 1e-4;
// No contact pushes two bodies apart faster than this: a body that lands stays down.
constexpr double kMostLeavingMps = 0.05;
// A contact that comes deeper than this within one step was met too late.
constexpr double kLateM = 1e-3;
// A step that is shortened for that ends so deep in the contact.
constexpr double kMetM = 1e-4;
constexpr double kBriefest = 1.0 / 16;  // of the step

Vector3d ToEigen(const SimTK::Vec3& v) { return {v[0], v[1], v[2]}; }

}  // namespace

void ContactStep::AddRow(const SimbodyTree& tree, const Contact& contact, double h) {
  Row row;
  row.contact = contact;
  row.before.setZero();
  by_all_.setZero(3, reduced_count_);
  for (const auto& [index, sign] : {std::pair{contact.first, 1.0}, {contact.second, -1.0}}) {
    const double way = sign;
    tree.ForEachSpeedOf(index, contact.touch.point, [&](int speed, const SimTK::Vec3& velocity) {
      const Vector3d by_one = way * ToEigen(velocity);
      const ReducedSpeed& reduced = reduced_[static_cast<std::size_t>(speed)];
      by_all_.col(reduced.of) += reduced.times * by_one;
      row.before += speeds_[speed] * by_one;
    });
  }
  for (Eigen::Index speed = 0; speed < reduced_count_; ++speed) {
    if (!by_all_.col(speed).isZero(0)) row.speeds.push_back(speed);
  }
  row.jacobian = by_all_(Eigen::all, row.speeds);
  const Vector3d normal = ToEigen(contact.touch.normal);
  row.sliding = row.before - normal * normal.dot(row.before);
  row.normal_n = contact.touch.weight * contact.stiffness_npm * contact.touch.depth;
  // The deeper, the more damping: the spring then holds nothing at kMostLeavingMps.
  const double deep = contact.touch.depth + h * std::max(0.0, -normal.dot(row.before));
  row.contact.damping_nspm += contact.stiffness_npm * deep / kMostLeavingMps;
  rows_.push_back(std::move(row));
}

// Finds the forces that depend neither on the contacts nor on what is assumed of drives.
void ContactStep::FindForces(SimbodyTree& tree) {
  const SimTK::State& state = tree.evaluated();
  const int all = state.getNU();
  tree.FindMass(&whole_mass_);
  speeds_ = Eigen::Map<const Eigen::VectorXd>(state.getU().getContiguousScalarData(), all);
  const Eigen::Map<const Eigen::VectorXd> rates(state.getUDot().getContiguousScalarData(), all);
  all_forces_ = whole_mass_ * rates;
  tree.joint_force().Slopes(state, &by_speed_, &by_coordinate_);
  tree.joint_force().FindDrives(state, &drives_);
  at_limit_.assign(drives_.size(), 0);
  // Drives that are at their limits now may be free at the end.
  for (const JointForce::LimitedDrive& of : drives_) {
    const double effort = EffortOf(of.drive, kNoLimit, of.position, of.velocity);
    if (std::abs(effort) < of.limit) continue;
    all_forces_(static_cast<Eigen::Index>(of.speed)) +=
        effort - std::clamp(effort, -of.limit, of.limit);
    by_speed_[of.speed] += std::max(0.0, of.drive.damping);
    by_coordinate_[of.speed] += std::max(0.0, of.drive.stiffness);
  }
}

// Assembles the mass matrix with what joints hold against, and the forces.
void ContactStep::Assemble(double h) {
  Eigen::MatrixXd whole = whole_mass_;
  Eigen::VectorXd forces = all_forces_;
  for (Eigen::Index i = 0; i < forces.size(); ++i) {
    const auto slot = static_cast<std::size_t>(i);
    forces(i) -= h * by_coordinate_[slot] * speeds_(i);
    whole(i, i) += h * by_speed_[slot] + h * h * by_coordinate_[slot];
  }
  ReduceSystem(reduced_, reduced_count_, whole, forces, &mass_, &force_);
}

Eigen::VectorXd ContactStep::WholeChange() const { return SpreadToAll(reduced_, change_); }

// Whether one more servo would give more than it can at the end of the step.
bool ContactStep::ReachLimits(double h) {
  const Eigen::VectorXd end = speeds_ + WholeChange();
  bool is_new = false;
  for (std::size_t i = 0; i < drives_.size(); ++i) {
    if (at_limit_[i] != 0) continue;
    const JointForce::LimitedDrive& of = drives_[i];
    const auto speed = static_cast<Eigen::Index>(of.speed);
    const double effort = EffortOf(of.drive, kNoLimit, of.position + h * end[speed], end[speed]);
    if (!(std::abs(effort) > of.limit)) continue;
    is_new = true;
    at_limit_[i] = effort > 0 ? of.limit : -of.limit;
    all_forces_(speed) += at_limit_[i] - EffortOf(of.drive, kNoLimit, of.position, of.velocity);
    by_speed_[of.speed] -= std::max(0.0, of.drive.damping);
    by_coordinate_[of.speed] -= std::max(0.0, of.drive.stiffness);
  }
  return is_new;
}

void ContactStep::Solve(double h) {
  system_ = mass_;
  impulses_ = h * force_;
  for (Row& row : rows_) {
    row.is_solved_for = !row.is_open;
    if (row.is_open) continue;
    const Contact& contact = row.contact;
    const Vector3d normal = ToEigen(contact.touch.normal);
    const double weight = contact.touch.weight;
    const double along = weight * (contact.damping_nspm + h * contact.stiffness_npm);
    const double across = contact.friction * row.normal_n / std::max(kStickMps, row.sliding.norm());
    row.across_nspm = across;
    const Matrix3d slope =
        (along - across) * normal * normal.transpose() + across * Matrix3d::Identity();
    const Vector3d force =
        weight * contact.stiffness_npm * contact.touch.depth * normal - slope * row.before;
    const Eigen::Matrix<double, 3, Eigen::Dynamic> by_speed = h * slope * row.jacobian;
    for (std::size_t i = 0; i < row.speeds.size(); ++i) {
      const Vector3d column = row.jacobian.col(static_cast<Eigen::Index>(i));
      for (std::size_t k = 0; k < row.speeds.size(); ++k) {
        system_(row.speeds[k], row.speeds[i]) +=
            by_speed.col(static_cast<Eigen::Index>(k)).dot(column);
      }
      impulses_[row.speeds[i]] += h * column.dot(force);
    }
  }
  if (rubbing_.empty()) {
    change_ = impulses_;
    SolveByBranches(&system_, &change_);
  } else {
    impulse_bounds_ = h * bounds_;
    FindHeldChange(system_, impulses_, rubbing_, rubbing_speed_, impulse_bounds_, &at_bound_,
                   &hold_, &change_);
  }
}

void ContactStep::FindFriction(const SimbodyTree& tree) {
  rubbing_.clear();
  const Forest& forest = tree.forest();
  const SimTK::State& state = tree.evaluated();
  Eigen::VectorXd friction = Eigen::VectorXd::Zero(state.getNU());
  for (std::size_t body = 0; body < forest.bodies.size(); ++body) {
    const StateSlots& slots = tree.slots()[body];
    const auto first = static_cast<Eigen::Index>(slots.u) - state.getNQ();
    friction.segment(first, static_cast<Eigen::Index>(slots.u_count))
        .setConstant(FrictionOf(forest, body));
  }
  if (friction.isZero(0)) return;
  Eigen::VectorXd bounds = Eigen::VectorXd::Zero(reduced_count_);
  std::vector<double> speeds(static_cast<std::size_t>(reduced_count_));
  for (std::size_t i = 0; i < reduced_.size(); ++i) {
    const auto own = static_cast<Eigen::Index>(i);
    bounds[reduced_[i].of] += std::abs(reduced_[i].times) * friction[own];
    if (!reduced_[i].is_follower) speeds[static_cast<std::size_t>(reduced_[i].of)] = speeds_[own];
  }
  std::vector<double> rubbing_speeds;
  for (Eigen::Index column = 0; column < reduced_count_; ++column) {
    if (bounds[column] <= 0) continue;
    rubbing_.push_back(column);
    rubbing_speeds.push_back(speeds[static_cast<std::size_t>(column)]);
  }
  bounds_ = bounds(rubbing_);
  rubbing_speed_ = Eigen::Map<const Eigen::VectorXd>(rubbing_speeds.data(), bounds_.size());
  at_bound_.assign(rubbing_.size(), 0);
}

// Finds the contacts' forces at the end of the step. Returns whether these are not yet the assumed
// ones.
bool ContactStep::Update(double h) {
  bool has_changed = false;
  for (Row& row : rows_) {
    const Contact& contact = row.contact;
    const Vector3d normal = ToEigen(contact.touch.normal);
    const Eigen::VectorXd change = change_(row.speeds);
    const Vector3d velocity = row.before + row.jacobian * change;
    const double leaving = normal.dot(velocity);
    const double pushes =
        contact.touch.weight * (contact.stiffness_npm * (contact.touch.depth - h * leaving) -
                                contact.damping_nspm * leaving);
    row.along_n = pushes;
    const bool was_open = row.is_open;
    row.is_open = pushes <= 0;
    const double before_n = row.normal_n;
    row.normal_n = std::max(0.0, pushes);
    row.sliding = velocity - normal * leaving;
    has_changed = has_changed || was_open != row.is_open ||
                  std::abs(row.normal_n - before_n) > 1e-6 * before_n ||
                  row.sliding.norm() > kStickMps;
  }
  return has_changed;
}

void ContactStep::ReadForces(std::vector<ShapeContact>* contacts) const {
  contacts->clear();
  for (const Row& row : rows_) {
    if (!row.is_solved_for) continue;
    const Contact& contact = row.contact;
    const Vector3d normal = ToEigen(contact.touch.normal);
    const Vector3d force = row.along_n * normal - row.across_nspm * row.sliding;
    contacts->push_back({contact.first_shape,
                         contact.second_shape,
                         ToArray(contact.touch.point),
                         ToArray(contact.touch.normal),
                         {force[0], force[1], force[2]}});
  }
}

void ContactStep::TakeUpToTouch(SimbodyTree& tree, ModelLoads& loads, IslandStep& step,
                                double length_s) {
  const bool is_fast = tree.MayComeDeeper(step.from, length_s, kLateM);
  Take(tree, loads, step, length_s);
  if (!is_fast || !std::isfinite(step.to.back())) return;
  const double late_s = tree.LatenessOfTouch(step.to, kLateM, kMetM);
  if (late_s <= 0 || late_s >= length_s) return;
  Take(tree, loads, step, WholeNanoseconds(std::max(length_s - late_s, kBriefest * length_s)));
}

void ContactStep::Take(SimbodyTree& tree, ModelLoads& loads, IslandStep& step, double h) {
  const std::size_t size = step.from.size();
  step.from_rate.resize(size);
  tree.Evaluate(step.from, loads.MeanOver(step, h), step.from_rate.data());
  const SimTK::State& state = tree.evaluated();
  step.length_s = h;
  step.next_try_s = step.try_s;
  step.course.clear();
  step.to = step.from;
  rows_.clear();
  const bool is_known = std::isfinite(step.from_rate.back());
  if (is_known) {
    reduced_count_ = Reduce(tree, &reduced_);
    FindForces(tree);
    FindFriction(tree);
    tree.contacts().Find(state, &contacts_);
    tree.FindJointAxes();
    for (const Contact& contact : contacts_) AddRow(tree, contact, h);
    do {
      Assemble(h);
      for (int round = 0; round < kRounds; ++round) {
        Solve(h);
        if (!Update(h)) break;
      }
    } while (ReachLimits(h));
    const Eigen::VectorXd change = WholeChange();
    const int coordinates = state.getNQ();
    SimTK::Vector speeds = state.getU(), rates;
    for (int i = 0; i < speeds.size(); ++i) speeds[i] += change(i);
    tree.matter().multiplyByN(state, false, speeds, rates);
    for (int i = 0; i < coordinates; ++i) step.to[static_cast<std::size_t>(i)] += h * rates[i];
    for (int i = 0; i < speeds.size(); ++i) {
      step.to[static_cast<std::size_t>(coordinates + i)] = speeds[i];
    }
    tree.Project(step.to);
  } else {
    step.to = step.from_rate;  // not finite: the code that took the step says so
  }
  // In between the motion is uniform.
  step.to_rate.resize(size);
  for (std::size_t i = 0; i < size; ++i) {
    step.from_rate[i] = step.to_rate[i] = (step.to[i] - step.from[i]) / h;
  }
}

}  // namespace tcs
