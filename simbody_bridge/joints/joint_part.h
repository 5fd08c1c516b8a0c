// Joints that push each other, in a step of their own: springs, dampers and friction in closed form
// (servo_motion.h). In the course of a step each joint that has friction slides one way, with a
// constant force against it, or stands still and is held. A step ends where one of these changes.
//
// Everything else that acts comes from an engine, which gives the mass matrix and the accelerations
// without friction where it is asked to.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <limits>
#include <vector>

#include "simbody_bridge/joints/servo_motion.h"

namespace tcs {

// A step that still ends too late for what happens first is tried again no more often than this.
inline constexpr int kMostEventTries = 8;
// A step of a set length has no more pieces than this; an event in the last piece is passed over.
inline constexpr int kMostStepPieces = 1000;

class JointPart {
 public:
  // A part with the speeds of these places among all speeds. The part's speeds are `reduction`
  // times those of joints that mimic no other; `keeps_mimics` says that the engine's accelerations
  // are, too. `friction` is of each speed.
  JointPart(std::vector<std::size_t> places, Eigen::MatrixXd reduction, Eigen::VectorXd friction,
            bool keeps_mimics);

  const std::vector<std::size_t>& places() const { return places_; }
  std::size_t size() const { return places_.size(); }
  bool has_friction() const { return has_friction_; }
  // Whether a step needs the masses of its middle and its end, too.
  bool needs_masses() const { return needs_masses_; }

  // Takes the part's speeds from all speeds; and writes them back.
  Eigen::VectorXd Gather(const double* all) const;
  void Scatter(const Eigen::VectorXd& own, double* all) const;
  void Scatter(const JointMotion& own, double* way, double* speed) const;
  // The part's own mass matrix, of the mass matrix of all speeds; NeededMassIn gives it only if a
  // step needs it.
  Eigen::MatrixXd MassIn(const Eigen::MatrixXd& all) const { return all(places_, places_); }
  Eigen::MatrixXd NeededMassIn(const Eigen::MatrixXd& all) const {
    return needs_masses_ ? MassIn(all) : Eigen::MatrixXd();
  }

  // The values that a step begins with, of each speed of the part. The rates are without friction,
  // but with dampers and springs, whose efforts fall by `by_speed` with each speed and by
  // `by_coordinate` with each coordinate.
  struct Start {
    Eigen::MatrixXd mass;
    Eigen::VectorXd speed, rate, by_speed, by_coordinate;
    double longest_s = std::numeric_limits<double>::infinity();  // no try is longer
  };
  void Begin(const Start& start);
  // Tries a step of `h` seconds, in this order, as ServoMotion does.
  const JointMotion& Middle(double h);
  const JointMotion& End(const Eigen::MatrixXd& middle_mass, const Eigen::VectorXd& middle_rate);
  const JointMotion& Arrive(const Eigen::MatrixXd& end_mass, const Eigen::VectorXd& end_rate);
  // The time at which the first joint comes to rest in the step that was tried, or a joint that is
  // held breaks away; else the step's length.
  double FirstEvent();
  // Sets the speeds to 0, among all speeds, of the joints that have come to rest at the step's end.
  void BringToRest(double* all) const;

  const ServoMotion& motion() const { return motion_; }
  // The rates with friction, and as joints that mimic others have to go, in this step.
  Eigen::VectorXd Rate(const Eigen::MatrixXd& mass, const Eigen::VectorXd& rate) const;

 private:
  enum class Slip { kFree, kForwards, kBackwards, kHeld };
  struct Reduced;

  double SignOf(Eigen::Index column) const;
  bool IsSliding(Eigen::Index column) const { return SignOf(column) != 0; }
  Reduced Reduce(const Start& start) const;
  void FindSlips(Reduced* reduced);
  bool Arrest(const Start& start, Reduced* reduced, Start* arrested) const;
  Eigen::VectorXd Sliding() const;
  void Linearise(const Start& start);
  Eigen::VectorXd Excess(const Eigen::MatrixXd& mass, const Eigen::VectorXd& rate,
                         const Eigen::VectorXd& with_friction) const;
  double SpeedAfter(Eigen::Index column, double seconds, double* rate);
  double Crossing(Eigen::Index column, double until_s);
  double FirstBreakaway() const;

  const std::vector<std::size_t> places_;
  const Eigen::MatrixXd reduction_;
  const Eigen::VectorXd friction_;
  Eigen::VectorXd bounds_;             // of each column of the reduction
  std::vector<Eigen::Index> leaders_;  // the speed that is a column's own
  bool has_friction_ = false, needs_masses_ = false;

  // Of the step that has begun.
  ServoMotion motion_;
  ServoPush push_;
  std::vector<Slip> slips_;  // of each column
  Eigen::MatrixXd moving_;   // the columns that are not held
  Eigen::VectorXd sliding_;  // friction along each speed that is not held
  double h_ = 0;
  // The excess of the effort that each held column needs over the friction that it has, as a part
  // of that friction.
  std::array<Eigen::VectorXd, 3> excess_;  // at the start, in the middle, at the end
  std::vector<double> rest_at_s_;          // of each column
};

}  // namespace tcs
