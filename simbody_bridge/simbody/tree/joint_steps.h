// Steps of an island of models in which servos hold joints, or joints have damping or friction:
// exponential Runge-Kutta 3(2), in which drives, damping and stops act in closed form
// (joints/servo_motion.h), and friction as it is: a joint slides, or is held (joints/joint_part.h).
// Like all steps they are functions of a state and of what acts.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "simbody_bridge/joints/joint_part.h"
#include "simbody_bridge/joints/limit_crossings.h"
#include "simbody_bridge/simbody/tree/controlled_steps.h"

namespace tcs {

class JointSteps : public ControlledSteps<JointSteps> {
 public:
  enum class Fit {
    kNotNeeded,  // neither servos nor damping nor friction
    kFits,
    kTooLarge,  // servos hold so many joints at once that short steps are cheaper
  };
  Fit FitOf(const SimbodyTree& tree, std::span<const Wrench> acting);

  // Writes the step's course, too.
  void TakeControlled(SimbodyTree& tree, ModelLoads& loads, IslandStep& step, double accuracy,
                      double limit_s);
  // Takes a step as long as its limit, in pieces where joints come to rest or break away.
  void TakeWhole(SimbodyTree& tree, ModelLoads& loads, IslandStep& step);

  // Whether TakeControlled took the step.
  static bool Took(const IslandStep& step) { return !step.course.empty(); }
  // The state in the course of such a step.
  void Within(const SimbodyTree& tree, const IslandStep& step, double after_s,
              std::vector<double>* state);

 private:
  friend class ControlledSteps<JointSteps>;

  void Divide(const SimbodyTree& tree);
  bool IsLarge(const JointPart& part) const;
  void Begin(SimbodyTree& tree, ModelLoads& loads, IslandStep& step);
  void FindMass(SimbodyTree& tree, std::span<const double> state);
  void Try(SimbodyTree& tree, ModelLoads& loads, IslandStep& step, double h);
  void EndAtEvent(SimbodyTree& tree, ModelLoads& loads, IslandStep& step);
  double PredictKink(const SimbodyTree& tree, ModelLoads& loads, const IslandStep& step, double h);
  double LateKink(const SimbodyTree& tree, ModelLoads& loads, const IslandStep& step, double h);
  double FirstKink(const SimbodyTree& tree, ModelLoads& loads, const IslandStep& step, double h);
  void Place(const SimbodyTree& tree, const IslandStep& step, std::span<double> state);
  double ErrorOf(const SimbodyTree& tree, const IslandStep& step, double h);
  void WriteCourse(SimbodyTree& tree, IslandStep& step);

  std::vector<JointPart> parts_;  // joints that push each other are one part
  bool is_divided_ = false, has_own_ = false, needs_masses_ = false;
  std::size_t coordinates_ = 0;
  // Memory of the functions above.
  Eigen::MatrixXd mass_;
  std::vector<double> by_speed_, by_coordinate_;
  std::vector<double> state_, middle_rate_, end_rate_, error_;
  std::vector<double> way_, speed_;                    // of all speeds
  std::vector<double> turn_, middle_turn_, end_turn_;  // how coordinates grow
  LimitCrossings crossings_;
  std::vector<double> ratios_;
  IslandStep piece_;
  ServoStart start_;
  ServoPush push_;
};

}  // namespace tcs
