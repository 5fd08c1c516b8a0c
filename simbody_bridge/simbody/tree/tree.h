// An island of models as Simbody knows it: a mobilized body for each body of the forest. The
// island's motion is a function of its coordinates and speeds and of what acts; a SimTK::State is
// the memory in which that function is evaluated, and nothing is left in it from one evaluation to
// the next.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <span>
#include <vector>

#include "simbody_bridge/model/forest.h"
#include "simbody_bridge/model_engine.h"
#include "simbody_bridge/simbody/contact/contacts.h"
#include "simbody_bridge/simbody/kutta.h"
#include "simbody_bridge/simbody/simbody.h"
#include "simbody_bridge/simbody/tree/joint_force.h"

namespace tcs {

// A speed as a multiple of a leader's: `times` the speed number `of` among those of joints that
// mimic no other.
struct ReducedSpeed {
  Eigen::Index of = 0;
  double times = 1;
  bool is_follower = false;
};

class SimbodyTree {
 public:
  // `forest` and what it points into outlive this. Throws what Simbody throws if it refuses the
  // forest.
  SimbodyTree(const Forest& forest, const std::array<double, 3>& gravity_mps2);
  SimbodyTree(const SimbodyTree&) = delete;
  SimbodyTree& operator=(const SimbodyTree&) = delete;

  // The coordinates and then the speeds, at the start.
  const std::vector<double>& start() const { return start_; }
  std::span<const StateSlots> slots() const { return slots_; }

  // The derivatives of `state` where `acting` acts; NaN where Simbody cannot tell.
  void Evaluate(std::span<const double> state, std::span<const Wrench> acting, double* rate);
  // The same, for free where the same was asked for the last time: a step mostly begins where the
  // one before has ended.
  void EvaluateOrRecall(std::span<const double> state, std::span<const Wrench> acting,
                        double* rate);
  // How fast the coordinates of `state` grow at these speeds.
  void CoordinateRates(std::span<const double> state, std::span<const double> speeds,
                       std::span<double> rates) const;
  // For steps that are implicit in what acts along the joints: the mass matrix at `state`, of all
  // speeds, and JointForce::Slopes there where `acting` acts.
  void Linearise(std::span<const double> state, std::span<const Wrench> acting,
                 Eigen::MatrixXd* mass, std::vector<double>* by_speed,
                 std::vector<double>* by_coordinate);
  // The mass matrix at `state` alone.
  void FindMass(std::span<const double> state, Eigen::MatrixXd* mass);
  // The mass matrix of the state that was evaluated last.
  void FindMass(Eigen::MatrixXd* mass);
  // Finds the axes along which each joint moves the bodies that hang on it, in the state that was
  // evaluated last: for ForEachSpeedOf.
  void FindJointAxes();
  // Takes each speed (a number) that moves the body, with the velocity that 1 of it gives to
  // `point` (in the world) as a point of the body.
  template <class Each>
  void ForEachSpeedOf(int body, const SimTK::Vec3& point, const Each& each) const {
    for (int at = body; at != kWorldBody;
         at = forest_.bodies[static_cast<std::size_t>(at)].parent) {
      const StateSlots& slots = slots_[static_cast<std::size_t>(at)];
      const SimTK::Vec3 arm =
          point - bodies_[static_cast<std::size_t>(at)].getBodyOriginLocation(state_);
      const std::size_t first = slots.u - static_cast<std::size_t>(state_.getNQ());
      for (std::size_t speed = first; speed < first + slots.u_count; ++speed) {
        const SimTK::SpatialVec& axis = joint_axes_[speed];
        each(static_cast<int>(speed), SimTK::Vec3(axis[1] + axis[0] % arm));
      }
    }
  }
  // Makes quaternions unit length again.
  void NormaliseQuaternions(std::span<double> state) const;
  // The same, and takes joints that mimic others to where their leaders are.
  void Project(std::span<double> state);
  // No step from `state` on should be longer, so that error control does not miss a joint's stop.
  double LongestStepFrom(std::span<const double> state) const;
  // The time for which at least nothing touches; 0 where something may.
  double TimeToTouch(std::span<const double> state);
  // Whether something may have touched all the same within `seconds` from there to `state`.
  bool MayHaveTouched(std::span<const double> state, double seconds);
  // See Contacts; TimeToTouch was asked about `state` last.
  bool MayComeDeeper(std::span<const double> state, double seconds, double depth_m);
  double LatenessOfTouch(std::span<const double> state, double late_m, double met_m);

  // The last evaluation, for steps that go on from there: `evaluated` is the state as Simbody has
  // it, realized to Acceleration. The state's accelerations are as if no joint mimicked another.
  const Forest& forest() const { return forest_; }
  const SimTK::SimbodyMatterSubsystem& matter() const { return matter_; }
  const SimTK::State& evaluated() const { return state_; }
  const SimTK::MobilizedBody& body(int index) const {
    return bodies_[static_cast<std::size_t>(index)];
  }
  const JointForce& joint_force() const { return *joint_force_; }
  Contacts& contacts() { return *contacts_; }

  // Copies a body's part of a state into a state of another tree, in which the body is `to_body`.
  void CopyBody(std::size_t body, std::span<const double> state, const SimbodyTree& to,
                std::size_t to_body, std::span<double> into) const;
  void ReadLinks(std::span<const double> state, std::span<const int> links,
                 std::span<LinkState> read);
  void ReadJoints(std::span<const double> state, std::span<const Wrench> acting,
                  std::span<const int> joints, std::span<JointState> read) const;

 private:
  void AddBody(const TreeBody& body);
  void TieToLeaders(double* rates);
  void SetStart();
  void Load(std::span<const double> state);
  void ComputeMass();

  const Forest& forest_;
  SimTK::MultibodySystem system_;
  SimTK::SimbodyMatterSubsystem matter_{system_};
  SimTK::GeneralForceSubsystem forces_{system_};
  std::vector<SimTK::MobilizedBody> bodies_;
  std::vector<StateSlots> slots_;
  std::vector<double> start_;
  std::vector<ReducedSpeed> reduced_;  // of each speed, where joints mimic others; else none
  Eigen::Index reduced_count_ = 0;
  const JointForce* joint_force_ = nullptr;  // Simbody owns it
  std::unique_ptr<Contacts> contacts_;
  SimTK::State state_;
  bool is_loaded_ = false, has_mass_ = false;
  Eigen::MatrixXd mass_, tied_mass_;           // of the loaded state; memory of TieToLeaders
  std::vector<SimTK::SpatialVec> joint_axes_;  // of each speed
  std::span<const Wrench> acting_;             // while a state is evaluated
  struct {
    std::vector<double> state, rate;
    std::vector<Wrench> acting;
  } recalled_;
};

}  // namespace tcs
