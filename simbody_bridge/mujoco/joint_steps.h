// Steps of models whose joints have damping or friction, on MuJoCo, where nothing touches and no
// joint is in a stop: exponential Runge-Kutta 3, in which damping, friction and servos act in
// closed form (joints/joint_part.h). Runge-Kutta 4 takes damping as explicit, and diverges where a
// joint is light.
#pragma once

#include <mujoco/mujoco.h>

#include <Eigen/Core>
#include <functional>
#include <span>
#include <vector>

#include "simbody_bridge/joints/joint_part.h"
#include "simbody_bridge/model/forest.h"

namespace tcs {

class MujocoJointSteps {
 public:
  // `bodies` are MuJoCo's, for each body of `forest`, which outlives this.
  MujocoJointSteps(const Forest& forest, const mjModel& model, std::span<const int> bodies);

  // Whether a joint has damping or friction.
  bool AreNeeded() const { return are_needed_; }
  // Whether the stiffness of the drive of that speed acts in closed form, too.
  bool TakeStiffnessOf(int speed) const;

  // How forces fall with each of MuJoCo's speeds, and with each coordinate that is a joint's only
  // one.
  struct Slopes {
    std::vector<double> by_speed, by_coordinate;
  };
  // Finds all up to qacc_smooth where the positions are these, and the speeds those of the data;
  // false where something touches, or a joint is in a stop.
  using Find = std::function<bool(const double* positions)>;
  // Takes a step from where the data are, as long as the model has it. False: nothing is left that
  // can be used.
  bool Step(const mjModel& model, mjData* data, const Slopes& slopes, const Find& find);

 private:
  bool Try(const mjModel& model, mjData* data, double h, const Find& find);
  bool Go(const mjModel& model, mjData* data, const Find& find);
  void FollowLeaders(double* speeds, double* positions) const;
  void FindMass(const mjModel& model, const mjData& data);

  struct Follower {
    int speed, leading_speed, position, leading_position;
    double multiplier, offset;
  };
  std::vector<JointPart> parts_;
  std::vector<Follower> followers_;
  std::vector<bool> is_sprung_;  // of each speed: TakeStiffnessOf
  bool are_needed_ = false, need_masses_ = false;
  // Memory.
  Eigen::MatrixXd mass_;
  std::vector<double> start_, way_, speed_, positions_, end_speed_;
};

}  // namespace tcs
