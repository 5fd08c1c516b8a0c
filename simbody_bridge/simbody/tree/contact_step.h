// A step in which something touches: of first order, and implicit in what is stiff, so that hard
// contact, stiction, stops, servos and joints' own friction need no short steps.
//
// The speeds u' at the step's end solve M (u' - u) = h f(q + h u', u'), where f is taken as linear
// around the beginning along contacts' normals, in joints' dampers, stops and drives; contacts that
// would pull let go, and friction, which has the direction of the sliding at the end, is found by a
// few rounds. Joints' own friction holds them at the end of the step, or acts against the motion
// there (joints/dry_friction.h). A servo that would give more than it can at the end is held to its
// limit. Then q' = q + h N u'.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "simbody_bridge/contact_forces.h"
#include "simbody_bridge/island_engine.h"
#include "simbody_bridge/model_loads.h"
#include "simbody_bridge/simbody/tree/mimics.h"
#include "simbody_bridge/simbody/tree/tree.h"

namespace tcs {

class ContactStep {
 public:
  // Takes a step as long as `length_s`, within step.limit.
  void Take(SimbodyTree& tree, ModelLoads& loads, IslandStep& step, double length_s);
  // The same, but shorter where a body that comes fast would be deep in another one at the step's
  // end: the step ends where the two have just met.
  void TakeUpToTouch(SimbodyTree& tree, ModelLoads& loads, IslandStep& step, double length_s);
  // The contacts in the step that was taken last, with the forces that the step's speeds come from.
  void ReadForces(std::vector<ShapeContact>* contacts) const;

 private:
  // A contact's two bodies in one: velocities of the first beside the second at the point.
  struct Row {
    Contact contact;
    std::vector<Eigen::Index> speeds;                   // the reduced speeds that move it
    Eigen::Matrix<double, 3, Eigen::Dynamic> jacobian;  // by these, in the world
    Eigen::Vector3d before;                             // the velocity at the beginning
    double normal_n = 0;                                // force along the normal
    Eigen::Vector3d sliding = Eigen::Vector3d::Zero();  // across it, as in the last round
    bool is_open = false;                               // the contact would pull
    // In the last round.
    bool is_solved_for = false;  // the contact was not open
    double across_nspm = 0;      // of friction, by the speed of sliding
    double along_n = 0;          // of the spring and the damper; may be negative
  };
  void FindForces(SimbodyTree& tree);
  void Assemble(double h);
  bool ReachLimits(double h);
  void AddRow(const SimbodyTree& tree, const Contact& contact, double h);
  void FindFriction(const SimbodyTree& tree);
  void Solve(double h);
  Eigen::VectorXd WholeChange() const;  // of all speeds
  bool Update(double h);

  // See mimics.h.
  std::vector<ReducedSpeed> reduced_;
  Eigen::Index reduced_count_ = 0;
  // Of all speeds, and reduced with what joints hold against.
  Eigen::MatrixXd whole_mass_, mass_, system_;
  Eigen::VectorXd all_forces_, speeds_;
  std::vector<JointForce::LimitedDrive> drives_;
  std::vector<double> at_limit_;  // the effort each drive is held to; 0: it is free
  Eigen::VectorXd force_, change_;
  // Of the reduced speeds that have friction: their numbers, what friction holds, and the speeds
  // before.
  std::vector<Eigen::Index> rubbing_;
  Eigen::VectorXd bounds_, impulse_bounds_, rubbing_speed_, hold_;
  std::vector<int> at_bound_;  // see FindHeldChange; in a step each round goes on from the last one
  Eigen::VectorXd impulses_;
  std::vector<Contact> contacts_;
  // While a row is made: the velocities that all reduced speeds give.
  Eigen::Matrix<double, 3, Eigen::Dynamic> by_all_;
  std::vector<Row> rows_;
  std::vector<double> by_speed_, by_coordinate_;
};

}  // namespace tcs
