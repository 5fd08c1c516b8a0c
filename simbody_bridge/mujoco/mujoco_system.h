// A forest as MuJoCo knows it, as a function: from a state and the acting wrenches to the state one
// step later. Everything that MuJoCo itself remembers from step to step is written into it before
// each step: the guess that its solver begins with is part of the state.
//
// A smooth step is Runge-Kutta 4's; for joints with damping or friction the step is one in which
// these act in closed form (joint_steps.h). Where something touches, and where a servo is too stiff
// for that, the step is of first order and implicit in the servos, as on Simbody
// (simbody/tree/contact_step.h): explicit servos of wheels make these chatter, and slip.
#pragma once

#include <mujoco/mujoco.h>

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "simbody_bridge/contact_forces.h"
#include "simbody_bridge/load.h"
#include "simbody_bridge/model/forest.h"
#include "simbody_bridge/model_engine.h"
#include "simbody_bridge/mujoco/joint_steps.h"
#include "simbody_bridge/mujoco/runge_kutta4.h"
#include "simbody_bridge/mujoco/shape_pairs.h"

namespace tcs {

class MujocoSystem {
 public:
  // `forest` and what it points into outlive this. Throws DynamicsError if MuJoCo refuses the
  // forest.
  MujocoSystem(const Forest& forest, const std::array<double, 3>& gravity_mps2);

  // Positions, speeds, and the solver's guess, at the start.
  const std::vector<double>& start() const { return start_; }

  // Takes a step; `to` is not finite where MuJoCo cannot go on. `acting` is by place.
  void Step(std::span<const double> from, std::span<const Wrench> acting, double seconds,
            std::vector<double>* to);
  // Finds the contacts in such a step, with the means of their forces over the step.
  void FindForces(std::span<const double> from, std::span<const Wrench> acting, double seconds,
                  std::vector<ShapeContact>* contacts);

  // The body of the forest by whose joint a step has failed; -1: no step has, or the body is not
  // known.
  int failed_body() const { return failed_body_; }

  // Copies a body's part of a state into a state of another system, in which the body is `to_body`.
  void CopyBody(std::size_t body, std::span<const double> state, const MujocoSystem& to,
                std::size_t to_body, std::span<double> into) const;
  void ReadLinks(std::span<const double> state, std::span<const int> links,
                 std::span<LinkState> read);
  void ReadJoints(std::span<const double> state, std::span<const Wrench> acting,
                  std::span<const int> joints, std::span<JointState> read) const;

 private:
  struct DeleteModel {
    void operator()(mjModel* model) const { mj_deleteModel(model); }
  };
  struct DeleteData {
    void operator()(mjData* data) const { mj_deleteData(data); }
  };
  int IdOf(int type, char prefix, std::size_t index) const;
  void FindIds();
  void SetStart();
  void SetPose(std::size_t body);
  void SetState(std::span<const double> state);
  void ActOnLinks(std::span<const Wrench> acting);
  void ActInWorld(const TreeLink& link, const Load& load);
  JointDrive DriveOf(std::span<const Wrench> acting, std::size_t joint) const;
  void SetDrive(std::size_t joint, const JointDrive& drive);
  void FindPositions(const double* positions);
  void FindAccelerations();
  void FindAll(const double* positions);
  void Begin(std::span<const double> from, std::span<const Wrench> acting, double seconds);
  bool IsSmooth(std::span<const Wrench> acting, double seconds) const;
  bool IsInStop() const;
  bool IsAtLimit(std::span<const Wrench> acting, std::size_t joint) const;
  void AddForces(double share, std::vector<ShapeContact>* contacts) const;
  void AddForcesOfStages(double seconds, std::vector<ShapeContact>* contacts);
  void StepSmoothly();
  bool StepJoints(std::span<const Wrench> acting);
  bool TakesJoints(std::span<const double> from, std::span<const Wrench> acting, double seconds);
  void StepImplicitly(std::span<const Wrench> acting, double seconds);
  void SetArmature(int speed, double inertia);
  bool AreInOrder();
  bool ReachLimits(std::span<const Wrench> acting, double seconds);
  bool HasFailed() const;
  int BodyOfSpeed(int speed) const;
  void FindFailedBody();

  const Forest& forest_;
  std::unique_ptr<mjModel, DeleteModel> model_;
  std::unique_ptr<mjData, DeleteData> data_;
  std::vector<int> bodies_, body_actuators_;  // MuJoCo's, of each of the forest's bodies
  std::vector<int> joint_actuators_;          // of each joint; -1: none
  std::vector<int> positions_, speeds_;       // the places of each joint's; -1: fixed
  std::vector<std::size_t> shapes_;           // of the forest, of each of MuJoCo's geoms
  std::vector<double> start_;
  std::vector<double> inverse_inertias_;           // of each speed, as MuJoCo has found them
  std::unique_ptr<MujocoJointSteps> joint_steps_;  // null: no joint needs them
  MujocoJointSteps::Slopes slopes_;                // memory of StepJoints
  ShapePairs pairs_;
  int failed_body_ = -1;
  bool are_apart_ = false;  // where positions were found last
  RungeKutta4 runge_kutta_;
  std::vector<double> begin_;     // memory of Begin and AreInOrder: positions
  std::vector<double> at_limit_;  // memory: the effort each joint is held to; 0: free
  std::vector<Load> along_body_;  // memory of ActOnLinks
};

}  // namespace tcs
