#include "simbody_bridge/joints/servo_motion.h"

namespace tcs {
namespace {

using Eigen::VectorXd;

// The motion from the start's rate on, pushed by f1 and f2 on top of it.
JointMotion Answer(const ServoStart& start, const LinearResponse& response, const VectorXd& f1,
                   const VectorXd& f2) {
  return {response.seconds * start.speed + response.Way(start.rate, f1, f2),
          start.speed + response.Speed(start.rate, f1, f2)};
}

}  // namespace

JointMotion MotionAfter(const ServoStart& start, const ServoPush& push, double after_s) {
  LinearResponse response;
  if (start.has_springs) {
    FindResponse(start.stiffness, start.damping, after_s, &response, nullptr);
  } else {
    FindResponse(start.modes, after_s, &response);
  }
  const double share = after_s / push.seconds;
  return Answer(start, response, share * push.f1, share * share * push.f2);
}

double RateAlong(const ServoStart& start, const ServoPush& push, double after_s,
                 const JointMotion& motion, Eigen::Index speed) {
  const double share = after_s / push.seconds;
  double rate = start.rate[speed] + share * (push.f1[speed] + share * push.f2[speed]) -
                start.damping.row(speed).dot(motion.speed - start.speed);
  if (start.has_springs) {
    rate -= start.stiffness.row(speed).dot(motion.way - after_s * start.speed);
  }
  return rate;
}

// `drift_` is the springs' push where the joints go on as fast as they are; the response has the
// rest of the springs' push.
const JointMotion& ServoMotion::Middle(double h) {
  none_.setZero(start_.speed.size());
  if (start_.has_springs) {
    FindResponse(start_.stiffness, start_.damping, h, &whole_, &half_);
    drift_ = -h * (start_.stiffness * start_.speed);
  } else {
    FindResponse(start_.modes, h, &whole_);
    FindResponse(start_.modes, h / 2, &half_);
    drift_ = none_;
  }
  at_middle_ = Answer(start_, half_, drift_ / 2, none_);
  ahead_ = Answer(start_, whole_, drift_, none_);
  return at_middle_;
}

const JointMotion& ServoMotion::End(const VectorXd& middle_rate) {
  middle_ = Remainder(middle_rate, at_middle_);
  at_end_ = ahead_;
  at_end_.way += whole_.Way(2 * middle_, none_, none_);
  at_end_.speed += whole_.Speed(2 * middle_, none_, none_);
  return at_end_;
}

// The remainder grows as the parabola through its three values, of which the first is 0. Half of
// the parabola's difference from the straight line to the last value is the error: for speeds
// without springs and dampers it is that of the midpoint rule. Where joints are stiff, only the
// push at the end counts, and the midpoint rule's own push, a constant, is wrong there.
const JointMotion& ServoMotion::Arrive(const VectorXd& end_rate) {
  end_ = Remainder(end_rate, at_end_);
  const VectorXd f1 = 4 * middle_ - end_, f2 = 2 * end_ - 4 * middle_;
  arrived_ = Answer(start_, whole_, drift_ + f1, f2);
  const VectorXd bend = end_ - 2 * middle_;
  error_.way = whole_.Way(none_, -bend, bend);
  error_.speed = whole_.Speed(none_, -bend, bend);
  return arrived_;
}

ServoPush ServoMotion::Push() const {
  return {whole_.seconds, drift_ + 4 * middle_ - end_, 2 * end_ - 4 * middle_};
}

// The value in the middle is off by a fourth of what the value at the end is off by.
ServoPush ServoMotion::PushUntil(const VectorXd& rate) const {
  const VectorXd last = Remainder(rate, arrived_);
  const VectorXd middle = middle_ + (end_ - last) / 4;
  return {whole_.seconds, drift_ + 4 * middle - last, 2 * last - 4 * middle};
}

JointMotion ServoMotion::Along(const ServoPush& push) const {
  return Answer(start_, whole_, push.f1, push.f2);
}

VectorXd ServoMotion::Remainder(const VectorXd& rate, const JointMotion& motion) const {
  if (!start_.has_springs) {
    return rate - start_.rate + start_.damping * (motion.speed - start_.speed);
  }
  return rate - start_.rate + start_.stiffness * motion.way +
         start_.damping * (motion.speed - start_.speed);
}

}  // namespace tcs
