// A step of the joints of one model that servos hold, by an exponential Runge-Kutta method: springs
// and dampers in closed form, as they act at the step's beginning, and all that remains by Kutta's
// method of third order (Cox and Matthews, Exponential time differencing for stiff systems, Journal
// of Computational Physics 176, 2002: ETD3RK). However stiff a servo is, neither stability nor the
// haste with which a light joint follows its command keeps steps short. Without springs and dampers
// it is the method of kutta.h.
//
// Of u' = r(q, u), and of springs K and dampers D divided by the mass matrix, what remains is
// g = r - r0 + K w + D (u - u0). The way w is the integral of u since the step's beginning: for a
// joint with one coordinate, how far it has moved.
#pragma once

#include <Eigen/Core>

#include "simbody_bridge/joints/linear_response.h"

namespace tcs {

// Of each speed: the way since the step's beginning, and what it is.
struct JointMotion {
  Eigen::VectorXd way, speed;
};

// Springs and dampers by the mass, and how a step began.
struct ServoStart {
  bool has_springs = true;
  Eigen::MatrixXd stiffness, damping;  // of no springs the stiffness is 0, and not kept
  DampedModes modes;                   // of the dampers, where there are no springs
  Eigen::VectorXd speed, rate;
};

// What pushes the joints in the course of a step of `seconds`, beside the dampers and what of the
// springs is new: its rate at the beginning, and f1 s + f2 s^2 on top of it, where s grows to 1.
struct ServoPush {
  double seconds = 0;
  Eigen::VectorXd f1, f2;
};

// `after_s` from the beginning of such a step.
JointMotion MotionAfter(const ServoStart& start, const ServoPush& push, double after_s);

// How fast one speed grows there.
double RateAlong(const ServoStart& start, const ServoPush& push, double after_s,
                 const JointMotion& motion, Eigen::Index speed);

class ServoMotion {
 public:
  // What a step goes on from, to be written before it is tried.
  ServoStart& start() { return start_; }
  const ServoStart& start() const { return start_; }

  // Tries a step of `h` seconds: where its second rates are taken, then the third ones, then where
  // it leads. Each is valid until the next try.
  const JointMotion& Middle(double h);
  const JointMotion& End(const Eigen::VectorXd& middle_rate);
  const JointMotion& Arrive(const Eigen::VectorXd& end_rate);
  // How far off that may be.
  const JointMotion& error() const { return error_; }
  // Where it leads if nothing but springs and dampers changes what pushes: known after Middle.
  const JointMotion& ahead() const { return ahead_; }
  // Those of the last try.
  const JointMotion& middle() const { return at_middle_; }
  const JointMotion& arrived() const { return arrived_; }

  // What led to where it arrived.
  ServoPush Push() const;
  // In the course of the step, of the same order as where it leads; `rate` is what it is there.
  // Without springs and dampers that is the cubic through both ends and their derivatives.
  ServoPush PushUntil(const Eigen::VectorXd& rate) const;
  // Where that leads, but for what the method leaves open.
  JointMotion Along(const ServoPush& push) const;

 private:
  Eigen::VectorXd Remainder(const Eigen::VectorXd& rate, const JointMotion& motion) const;

  ServoStart start_;
  LinearResponse whole_, half_;
  Eigen::VectorXd drift_, none_;
  Eigen::VectorXd middle_, end_;  // what remains there
  JointMotion at_middle_, ahead_, at_end_, arrived_, error_;
};

}  // namespace tcs
