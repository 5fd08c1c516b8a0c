// A step of the joints of one model that servos hold, by an exponential Runge-Kutta method: springs
// and dampers in closed form, as they act at the step's beginning, and all that remains by Kutta's
// method of third order (Cox and Matthews, Exponential time differencing for stiff systems, Journal
// of Computational Physics 176, 2002: ETD3RK). However stiff a servo is, neither stability nor the
// haste with which a light joint follows its command keeps steps short. Without springs and dampers
// the method is that of kutta.h.
//
// For u' = r(q, u), and springs K and dampers D divided by the mass matrix, the remainder is
// g = r - r0 + K w + D (u - u0). The way w is the integral of u since the step's beginning: for a
// joint with one coordinate, how far it has moved.
#pragma once

#include <Eigen/Core>

#include "simbody_bridge/joints/linear_response.h"

namespace tcs {

// For each speed: the way since the step's beginning, and the speed itself.
struct JointMotion {
  Eigen::VectorXd way, speed;
};

// Springs and dampers by the mass, and how a step began.
struct ServoStart {
  bool has_springs = true;
  Eigen::MatrixXd stiffness, damping;  // without springs the stiffness is 0, and not kept
  DampedModes modes;                   // of the dampers, where there are no springs
  Eigen::VectorXd speed, rate;
};

// The push on the joints in the course of a step of `seconds`, beside the dampers and the new part
// of the springs: the rate at the beginning, and f1 s + f2 s^2 on top of it, where s grows to 1.
struct ServoPush {
  double seconds = 0;
  Eigen::VectorXd f1, f2;
};

// The motion `after_s` from the beginning of such a step.
JointMotion MotionAfter(const ServoStart& start, const ServoPush& push, double after_s);

// How fast the speed number `speed` grows there.
double RateAlong(const ServoStart& start, const ServoPush& push, double after_s,
                 const JointMotion& motion, Eigen::Index speed);

class ServoMotion {
 public:
  // The start that a step goes on from, to be written before the step is tried.
  ServoStart& start() { return start_; }
  const ServoStart& start() const { return start_; }

  // Tries a step of `h` seconds: Middle says where its second rates are taken, End where the third
  // ones are, Arrive where the step leads. Each result is valid until the next try.
  const JointMotion& Middle(double h);
  const JointMotion& End(const Eigen::VectorXd& middle_rate);
  const JointMotion& Arrive(const Eigen::VectorXd& end_rate);
  // How far off the arrival may be.
  const JointMotion& error() const { return error_; }
  // Where the step leads if nothing but springs and dampers changes the push: known after Middle.
  const JointMotion& ahead() const { return ahead_; }
  // The motions of the last try.
  const JointMotion& middle() const { return at_middle_; }
  const JointMotion& arrived() const { return arrived_; }

  // The push that led to where the step arrived.
  ServoPush Push() const;
  // The push in the course of the step, of the same order as the arrival; `rate` is the rate there.
  // Without springs and dampers that is the cubic through both ends and their derivatives.
  ServoPush PushUntil(const Eigen::VectorXd& rate) const;
  // Where `push` leads, but for what the method leaves open.
  JointMotion Along(const ServoPush& push) const;

 private:
  Eigen::VectorXd Remainder(const Eigen::VectorXd& rate, const JointMotion& motion) const;

  ServoStart start_;
  LinearResponse whole_, half_;
  Eigen::VectorXd drift_, none_;
  Eigen::VectorXd middle_, end_;  // the remainders there
  JointMotion at_middle_, ahead_, at_end_, arrived_, error_;
};

}  // namespace tcs
