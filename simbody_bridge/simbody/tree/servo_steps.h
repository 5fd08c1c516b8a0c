// Steps of an island of models in which servos hold joints: exponential Runge-Kutta 3(2), in which
// drives, damping, friction and stops act in closed form (servo_motion.h). Like all steps they
// are functions of a state and of what acts.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "simbody_bridge/simbody/tree/controlled_steps.h"
#include "simbody_bridge/simbody/tree/servo_motion.h"

namespace tcs {

class ServoSteps : public ControlledSteps<ServoSteps> {
 public:
  // Whether a servo acts, on an island of models that are not too large.
  static bool AreFor(const SimbodyTree& tree, std::span<const Wrench> acting);

  // Writes the step's course, too.
  void TakeControlled(SimbodyTree& tree, ModelLoads& loads, IslandStep& step, double accuracy,
                      double limit_s);

  // Whether it was TakeControlled that took the step.
  static bool Took(const IslandStep& step) { return !step.course.empty(); }
  // The state in the course of such a step.
  void Within(const SimbodyTree& tree, const IslandStep& step, double after_s,
              std::vector<double>* state);

 private:
  friend class ControlledSteps<ServoSteps>;

  // A model: others do not push its joints, so that it has a mass matrix of its own.
  struct Part {
    std::vector<std::size_t> speeds;  // of all
    Eigen::MatrixXd reduction;        // see mimics.h
    ServoMotion motion;
    ServoPush push;
  };
  void Divide(const SimbodyTree& tree);
  void Begin(SimbodyTree& tree, ModelLoads& loads, IslandStep& step);
  void Linearise(SimbodyTree& tree, std::span<const Wrench> acting, const IslandStep& step);
  void Try(SimbodyTree& tree, ModelLoads& loads, IslandStep& step, double h);
  void Place(const SimbodyTree& tree, const IslandStep& step, std::span<double> state);
  double ErrorOf(const SimbodyTree& tree, const IslandStep& step, double h);
  void WriteCourse(const SimbodyTree& tree, IslandStep& step);

  std::vector<Part> parts_;
  std::size_t coordinates_ = 0;
  // Memory of the functions above.
  SimTK::Matrix mass_;
  std::vector<double> by_speed_, by_coordinate_;
  std::vector<double> state_, middle_rate_, end_rate_, error_;
  std::vector<double> way_, speed_;                    // of all
  std::vector<double> turn_, middle_turn_, end_turn_;  // how coordinates grow
  ServoStart start_;
  ServoPush push_;
  ResponseFinder finder_;
};

}  // namespace tcs
