#include "tests/unit/engines/dart_robot.h"

#include <Eigen/Geometry>
#include <dart/dynamics/BodyNode.hpp>
#include <dart/dynamics/DegreeOfFreedom.hpp>
#include <dart/dynamics/FreeJoint.hpp>
#include <dart/dynamics/Skeleton.hpp>
#include <dart/utils/urdf/DartLoader.hpp>
#include <filesystem>
#include <stdexcept>

#include "tests/unit/engines/to_eigen.h"

namespace tcs {
namespace {

using dart::utils::DartLoader;
using Eigen::Isometry3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using Eigen::VectorXd;
using Vector6d = Eigen::Matrix<double, 6, 1>;

dart::dynamics::SkeletonPtr Read(const std::string& urdf, const std::string& packages,
                                 bool has_fixed_base) {
  DartLoader::Options options;
  options.mDefaultRootJointType =
      has_fixed_base ? DartLoader::RootJointType::FIXED : DartLoader::RootJointType::FLOATING;
  // By default DART makes 1 kg and 1 kg m^2 of a link of which the file says nothing.
  constexpr double kNextToNone = 1e-12;
  options.mDefaultInertia = {kNextToNone, Vector3d::Zero(),
                             kNextToNone * Eigen::Matrix3d::Identity()};
  DartLoader loader(options);
  for (const auto& entry : std::filesystem::directory_iterator(packages)) {
    loader.addPackageDirectory(entry.path().filename().string(), entry.path().string());
  }
  dart::dynamics::SkeletonPtr skeleton = loader.parseSkeleton("file://" + urdf);
  if (skeleton == nullptr) throw std::runtime_error("DART cannot read " + urdf);
  return skeleton;
}

}  // namespace

// The state: the orientation (w x y z) and the position of a free base, the joints' coordinates,
// all speeds. A free base's speeds are its angular and its linear velocity along its own axes.
class DartRobot::Motion {
 public:
  Motion(const std::string& urdf, const std::string& packages, const RobotModel& start,
         const std::array<double, 3>& gravity_mps2)
      : skeleton_(Read(urdf, packages, start.has_fixed_base)),
        base_(dynamic_cast<dart::dynamics::FreeJoint*>(skeleton_->getRootJoint())),
        base_dofs_(base_ != nullptr ? 6 : 0),
        joints_(static_cast<Eigen::Index>(skeleton_->getNumDofs()) - base_dofs_),
        efforts_(VectorXd::Zero(base_dofs_ + joints_)),
        state_(VectorXd::Zero(7 + joints_ + base_dofs_ + joints_)) {
    if ((base_ == nullptr) != start.has_fixed_base) throw std::runtime_error("DART's base differs");
    skeleton_->setGravity(ToEigen(gravity_mps2));
    // DART treats joints' damping as the end of a step of this length has it.
    skeleton_->setTimeStep(1e-12);
    SetBase(start);
    for (const Joint& joint : start.joints) {
      if (joint.initial_position.empty()) continue;
      const Eigen::Index index = IndexOf(joint.name);
      state_[7 + index - base_dofs_] = joint.initial_position[0];
      state_[7 + joints_ + index] = joint.initial_velocity.empty() ? 0 : joint.initial_velocity[0];
    }
    Load(state_);
  }

  Eigen::Index IndexOf(std::string_view joint) const {
    const auto* dof = skeleton_->getDof(std::string(joint));
    if (dof == nullptr) throw std::runtime_error("DART has no joint " + std::string(joint));
    return static_cast<Eigen::Index>(dof->getIndexInSkeleton());
  }
  void SetEffort(std::string_view joint, double effort) { efforts_[IndexOf(joint)] = effort; }

  void Advance(double seconds, int steps) {
    const double h = seconds / steps;
    for (int i = 0; i < steps; ++i) {
      const VectorXd a = RateOf(state_), b = RateOf(state_ + h / 2 * a);
      const VectorXd c = RateOf(state_ + h / 2 * b), d = RateOf(state_ + h * c);
      state_ += h / 6 * (a + 2 * b + 2 * c + d);
      state_.head<4>().normalize();
    }
    Load(state_);
  }

  double PositionOf(std::string_view joint) const {
    return skeleton_->getDof(std::string(joint))->getPosition();
  }
  Pose PoseOf(std::string_view link) const {
    const Isometry3d& at = skeleton_->getBodyNode(std::string(link))->getWorldTransform();
    const Quaterniond q(at.linear());
    const Vector3d p = fixed_base_ * at.translation();
    const Quaterniond turned = Quaterniond(fixed_base_.linear()) * q;
    return {{p.x(), p.y(), p.z()}, {turned.x(), turned.y(), turned.z(), turned.w()}};
  }

 private:
  void SetBase(const RobotModel& start) {
    const auto [x, y, z, w] = start.at.orientation_xyzw;
    const Quaterniond turned = Quaterniond(w, x, y, z).normalized();
    if (base_ == nullptr) {
      fixed_base_.linear() = turned.toRotationMatrix();
      fixed_base_.translation() = ToEigen(start.at.position_m);
      skeleton_->setGravity(turned.inverse() * skeleton_->getGravity());
      return;
    }
    state_.head<4>() << turned.w(), turned.x(), turned.y(), turned.z();
    state_.segment<3>(4) = ToEigen(start.at.position_m);
    state_.segment<3>(7 + joints_) = turned.inverse() * ToEigen(start.angular_velocity_radps);
    state_.segment<3>(10 + joints_) = turned.inverse() * ToEigen(start.linear_velocity_mps);
  }

  void Load(const VectorXd& state) {
    VectorXd positions(base_dofs_ + joints_);
    if (base_ != nullptr) {
      Isometry3d at = Isometry3d::Identity();
      at.linear() =
          Quaterniond(state[0], state[1], state[2], state[3]).normalized().toRotationMatrix();
      at.translation() = state.segment<3>(4);
      positions.head<6>() = dart::dynamics::FreeJoint::convertToPositions(at);
    }
    positions.tail(joints_) = state.segment(7, joints_);
    skeleton_->setPositions(positions);
    skeleton_->setVelocities(state.tail(base_dofs_ + joints_));
  }

  VectorXd RateOf(const VectorXd& state) {
    Load(state);
    skeleton_->setForces(efforts_);
    skeleton_->computeForwardDynamics();
    VectorXd rate = VectorXd::Zero(state.size());
    if (base_ != nullptr) {
      const Quaterniond q(state[0], state[1], state[2], state[3]);
      const Vector3d turning = state.segment<3>(7 + joints_);
      const Quaterniond turned = q * Quaterniond(0, turning.x(), turning.y(), turning.z());
      rate.head<4>() << turned.w() / 2, turned.x() / 2, turned.y() / 2, turned.z() / 2;
      rate.segment<3>(4) = q.normalized() * Vector3d(state.segment<3>(10 + joints_));
    }
    rate.segment(7, joints_) = state.tail(joints_);
    rate.tail(base_dofs_ + joints_) = skeleton_->getAccelerations();
    return rate;
  }

  const dart::dynamics::SkeletonPtr skeleton_;
  dart::dynamics::FreeJoint* const base_;  // none: it is fixed
  const Eigen::Index base_dofs_, joints_;
  Isometry3d fixed_base_ = Isometry3d::Identity();  // DART has it at the origin
  VectorXd efforts_, state_;
};

DartRobot::DartRobot(const std::string& urdf, const std::string& packages, const RobotModel& start,
                     const std::array<double, 3>& gravity_mps2)
    : motion_(std::make_unique<Motion>(urdf, packages, start, gravity_mps2)) {}
DartRobot::~DartRobot() = default;

void DartRobot::SetEffort(std::string_view joint, double effort) {
  motion_->SetEffort(joint, effort);
}
void DartRobot::Advance(double seconds, int steps) { motion_->Advance(seconds, steps); }
double DartRobot::PositionOf(std::string_view joint) const { return motion_->PositionOf(joint); }
Pose DartRobot::PoseOf(std::string_view link) const { return motion_->PoseOf(link); }

}  // namespace tcs
