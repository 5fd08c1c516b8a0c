#include "simbody_bridge/joints/joint_part.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "simbody_bridge/joints/dry_friction.h"

namespace tcs {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kNever = std::numeric_limits<double>::infinity();
// A joint that comes to rest within this time rests at once: steps are no shorter.
constexpr double kInstantS = 1e-9;
// A joint that has to go back as slowly as this has come to rest.
constexpr double kRestRadps = 1e-10;
// A joint that breaks away in this last part of a step does so at its end.
constexpr double kLastPart = 0.01;
// The shortest part of a step that ends because a joint breaks away, or turns round at once.
constexpr double kLeastPart = 1.0 / 16;

// Dampers that take less than this of a speed in a step, each alone and all together: Kutta's
// method is off by 1e-8 and 4e-6 of the speed for them.
constexpr double kSlow = 0.02, kSlowTogether = 0.1;

MatrixXd InverseOf(const MatrixXd& matrix) {
  return matrix.llt().solve(MatrixXd::Identity(matrix.rows(), matrix.cols()));
}

}  // namespace

// The part in the speeds that mimic no other.
struct JointPart::Reduced {
  MatrixXd mass, by_mass;
  VectorXd speed, force;  // the force without friction
};

JointPart::JointPart(std::vector<std::size_t> places, MatrixXd reduction, VectorXd friction,
                     bool keeps_mimics)
    : places_(std::move(places)),
      reduction_(std::move(reduction)),
      friction_(std::move(friction)),
      bounds_(reduction_.cwiseAbs().transpose() * friction_),
      has_friction_(bounds_.size() > 0 && bounds_.maxCoeff() > 0),
      needs_masses_(has_friction_ || (!keeps_mimics && reduction_.rows() != reduction_.cols())) {
  for (Index column = 0; column < reduction_.cols(); ++column) {
    Index leader = 0;
    while (reduction_(leader, column) != 1) ++leader;
    leaders_.push_back(leader);
  }
}

VectorXd JointPart::Gather(const double* all) const {
  VectorXd own(static_cast<Index>(places_.size()));
  for (std::size_t i = 0; i < places_.size(); ++i) own[static_cast<Index>(i)] = all[places_[i]];
  return own;
}

void JointPart::Scatter(const VectorXd& own, double* all) const {
  for (std::size_t i = 0; i < places_.size(); ++i) all[places_[i]] = own[static_cast<Index>(i)];
}

void JointPart::Scatter(const JointMotion& own, double* way, double* speed) const {
  Scatter(own.way, way);
  Scatter(own.speed, speed);
}

// Which way the joint slides; 0: it does not, or has no friction.
double JointPart::SignOf(Index column) const {
  const Slip slip = slips_[static_cast<std::size_t>(column)];
  return slip == Slip::kForwards ? 1 : slip == Slip::kBackwards ? -1 : 0;
}

JointPart::Reduced JointPart::Reduce(const Start& start) const {
  Reduced reduced;
  reduced.mass = reduction_.transpose() * start.mass * reduction_;
  reduced.by_mass = InverseOf(reduced.mass);
  reduced.force = reduction_.transpose() * (start.mass * start.rate);
  reduced.speed = start.speed(leaders_);
  return reduced;
}

void JointPart::FindSlips(Reduced* reduced) {
  const Index columns = reduction_.cols();
  slips_.assign(static_cast<std::size_t>(columns), Slip::kFree);
  std::vector<Index> resting;
  for (Index column = 0; column < columns; ++column) {
    if (bounds_[column] <= 0) continue;
    Slip& slip = slips_[static_cast<std::size_t>(column)];
    const double speed = reduced->speed[column];
    slip = speed > 0 ? Slip::kForwards : speed < 0 ? Slip::kBackwards : Slip::kHeld;
    reduced->force[column] -= SignOf(column) * bounds_[column];
    if (slip == Slip::kHeld) resting.push_back(column);
  }
  if (resting.empty()) return;
  const MatrixXd by_mass = reduced->by_mass(resting, Eigen::all);
  const VectorXd rates = by_mass * reduced->force;
  VectorXd hold;
  FindHolds(reduced->by_mass(resting, resting), rates, bounds_(resting), &hold);
  for (std::size_t i = 0; i < resting.size(); ++i) {
    const double bound = bounds_[resting[i]], effort = hold[static_cast<Index>(i)];
    if (std::abs(effort) < bound) continue;
    slips_[static_cast<std::size_t>(resting[i])] = effort < 0 ? Slip::kForwards : Slip::kBackwards;
  }
}

// Stops the joints that come to rest within an instant; the other joints then have the speeds that
// the blow leaves them. Returns whether there are any such joints.
bool JointPart::Arrest(const Start& start, Reduced* reduced, Start* arrested) const {
  const VectorXd rates = reduced->by_mass * reduced->force;
  const VectorXd damping =
      (reduction_.transpose() * start.by_speed.asDiagonal() * reduction_).diagonal();
  std::vector<Index> resting, moving;
  bool is_new = false;
  for (Index column = 0; column < reduction_.cols(); ++column) {
    const double sign = SignOf(column), speed = reduced->speed[column] * sign;
    bool rests = bounds_[column] > 0 && reduced->speed[column] == 0;
    if (speed > 0) {
      // As if the other joints stood still meanwhile.
      const double mass = 1 / reduced->by_mass(column, column);
      const double against = -sign * rates[column] * mass - damping[column] * speed;
      const double decay = damping[column] / mass;
      const double rest_s = against <= 0 ? kNever
                            : damping[column] > 0
                                ? std::log1p(damping[column] * speed / against) / decay
                                : speed * mass / against;
      rests = rest_s < kInstantS;
      is_new = is_new || rests;
    }
    (rests ? resting : moving).push_back(column);
  }
  if (!is_new) return false;
  const VectorXd momentum = reduced->mass * reduced->speed;
  VectorXd speed = VectorXd::Zero(reduced->speed.size());
  if (!moving.empty()) {
    const VectorXd left =
        MatrixXd(reduced->mass(moving, moving)).llt().solve(VectorXd(momentum(moving)));
    speed(moving) = left;
  }
  *arrested = start;
  arrested->speed = reduction_ * speed;
  const VectorXd lost = arrested->speed - start.speed;
  arrested->rate -= InverseOf(start.mass) * start.by_speed.cwiseProduct(lost);
  return true;
}

VectorXd JointPart::Sliding() const {
  VectorXd sliding = VectorXd::Zero(reduction_.rows());
  for (Index row = 0; row < reduction_.rows(); ++row) {
    for (Index column = 0; column < reduction_.cols(); ++column) {
      const double share = reduction_(row, column);
      if (share == 0) continue;
      sliding[row] -= friction_[row] * SignOf(column) * (share > 0 ? 1 : -1);
    }
  }
  return sliding;
}

void JointPart::Begin(const Start& start) {
  const Start* from = &start;
  Start arrested;
  if (has_friction_) {
    Reduced reduced = Reduce(start);
    FindSlips(&reduced);
    if (Arrest(start, &reduced, &arrested)) {
      from = &arrested;
      reduced = Reduce(arrested);
      FindSlips(&reduced);
    }
    sliding_ = Sliding();
    std::vector<Index> moving;
    for (Index column = 0; column < reduction_.cols(); ++column) {
      if (slips_[static_cast<std::size_t>(column)] != Slip::kHeld) moving.push_back(column);
    }
    moving_ = reduction_(Eigen::all, moving);
  } else {
    slips_.assign(static_cast<std::size_t>(reduction_.cols()), Slip::kFree);
    moving_ = reduction_;
    sliding_.setZero(reduction_.rows());
  }
  rest_at_s_.assign(slips_.size(), kNever);
  h_ = 0;
  Linearise(*from);
}

// Joints that mimic others move as these do: the mass is that of both. Dampers that are slow beside
// the step need no closed form, whose cost is the cube of the number of dampers that have one.
void JointPart::Linearise(const Start& from) {
  ServoStart& start = motion_.start();
  MatrixXd by_mass = MatrixXd::Zero(reduction_.rows(), reduction_.rows());
  if (moving_.cols() > 0) {
    by_mass =
        moving_ *
        (moving_.transpose() * from.mass * moving_).llt().solve(MatrixXd(moving_.transpose()));
  }
  VectorXd dampers = from.by_speed;
  start.has_springs = !from.by_coordinate.isZero(0);
  if (start.has_springs) {
    start.stiffness = by_mass * from.by_coordinate.asDiagonal();
  } else {
    // The sum of what each damper takes is no less than what the fastest motion of all loses.
    const VectorXd takes = from.longest_s * by_mass.diagonal().cwiseProduct(dampers);
    const auto is_slow = (takes.array() < kSlow).eval();
    if (is_slow.select(takes.array(), 0.0).sum() < kSlowTogether) {
      dampers = is_slow.select(0.0, dampers);
    }
    FindModes(by_mass, dampers, &start.modes);
  }
  start.damping = by_mass * dampers.asDiagonal();
  start.speed = from.speed;
  start.rate = Rate(from.mass, from.rate);
  excess_[0] = Excess(from.mass, from.rate, start.rate);
}

VectorXd JointPart::Rate(const MatrixXd& mass, const VectorXd& rate) const {
  if (!needs_masses_) return rate;
  if (moving_.cols() == 0) return VectorXd::Zero(rate.size());
  return moving_ * (moving_.transpose() * mass * moving_)
                       .llt()
                       .solve(moving_.transpose() * (mass * rate + sliding_));
}

VectorXd JointPart::Excess(const MatrixXd& mass, const VectorXd& rate,
                           const VectorXd& with_friction) const {
  VectorXd excess = VectorXd::Constant(reduction_.cols(), -1);
  if (!has_friction_ || moving_.cols() == reduction_.cols()) return excess;
  const VectorXd held = reduction_.transpose() * (mass * (with_friction - rate) - sliding_);
  for (Index column = 0; column < excess.size(); ++column) {
    if (slips_[static_cast<std::size_t>(column)] != Slip::kHeld) continue;
    excess[column] = std::abs(held[column]) / bounds_[column] - 1;
  }
  return excess;
}

const JointMotion& JointPart::Middle(double h) {
  if (h == h_) return motion_.middle();
  h_ = h;
  return motion_.Middle(h);
}

const JointMotion& JointPart::End(const MatrixXd& middle_mass, const VectorXd& middle_rate) {
  const VectorXd rate = Rate(middle_mass, middle_rate);
  excess_[1] = Excess(middle_mass, middle_rate, rate);
  return motion_.End(rate);
}

const JointMotion& JointPart::Arrive(const MatrixXd& end_mass, const VectorXd& end_rate) {
  const VectorXd rate = Rate(end_mass, end_rate);
  excess_[2] = Excess(end_mass, end_rate, rate);
  return motion_.Arrive(rate);
}

double JointPart::FirstEvent() {
  double first_s = h_;
  if (!has_friction_) return first_s;
  push_ = motion_.Push();
  for (Index column = 0; column < reduction_.cols(); ++column) {
    const double sign = SignOf(column);
    if (sign == 0) continue;
    const Index leader = leaders_[static_cast<std::size_t>(column)];
    const double end = sign * motion_.arrived().speed[leader];
    const double middle = sign * motion_.middle().speed[leader];
    double& rest_s = rest_at_s_[static_cast<std::size_t>(column)];
    if (end < -kRestRadps) {
      rest_s = Crossing(column, h_);
    } else if (double rate = 0;
               middle < -kRestRadps && sign * SpeedAfter(column, h_ / 2, &rate) < 0) {
      rest_s = Crossing(column, h_ / 2);
    } else if (end < 0) {
      rest_s = h_;
    }
    first_s = std::min(first_s, rest_s);
  }
  return std::min(first_s, FirstBreakaway());
}

double JointPart::SpeedAfter(Index column, double seconds, double* rate) {
  const ServoStart& start = motion_.start();
  const Index leader = leaders_[static_cast<std::size_t>(column)];
  const JointMotion motion = MotionAfter(start, push_, seconds);
  *rate = RateAlong(start, push_, seconds, motion, leader);
  return motion.speed[leader];
}

// The time at which a sliding joint comes to rest before `until_s`: by Newton's method, and where
// that leads out of the known bracket, by halves, at first of the logarithm. A joint that begins at
// rest and goes the other way at once comes to rest at once; the result is a part of the step then.
double JointPart::Crossing(Index column, double until_s) {
  constexpr int kMostRounds = 60;
  const double sign = SignOf(column);
  const Index leader = leaders_[static_cast<std::size_t>(column)];
  const double start = sign * motion_.start().speed[leader];
  double low = 0, high = until_s;
  double next = start > 0 ? -start / (sign * motion_.start().rate[leader]) : 0;
  bool has_slid = start > 0;
  for (int round = 0; round < kMostRounds && high - low > kInstantS / 4; ++round) {
    if (!(next > low && next < high)) {
      const double least = std::max(low, kInstantS / 10);
      next = high > 10 * least ? std::sqrt(least * high) : (low + high) / 2;
    }
    double rate = 0;
    const double at = sign * SpeedAfter(column, next, &rate);
    if (has_slid && std::abs(at) < kRestRadps) return next;
    has_slid = has_slid || at > kRestRadps;
    (at > 0 ? low : high) = next;
    const double change = -at / (sign * rate);
    next += change;
    if (has_slid && std::abs(change) < kInstantS / 8 && next > low && next < high) return next;
  }
  return start > 0 ? high : std::max(high, kLeastPart * h_);
}

// The time of the first breakaway, by the parabola through the known excesses of each joint that is
// held.
double JointPart::FirstBreakaway() const {
  constexpr double kRounding = 1e-9;
  constexpr int kLooks = 64;
  double first = 1;
  for (Index column = 0; column < reduction_.cols(); ++column) {
    const double start = std::min(excess_[0][column], 0.0);
    const double middle = excess_[1][column], end = excess_[2][column];
    if (!(middle > kRounding) && !(end > kRounding)) continue;
    const double curve = 2 * (end + start - 2 * middle), slope = end - start - curve;
    for (int look = 1; look <= kLooks; ++look) {
      const double at = static_cast<double>(look) / kLooks;
      if (at >= first) break;
      const double there = start + at * (slope + at * curve);
      if (there <= 0) continue;
      const double before = start + (at - 1.0 / kLooks) * (slope + (at - 1.0 / kLooks) * curve);
      first = at - there / (there - before) / kLooks;
      break;
    }
  }
  return first > 1 - kLastPart ? h_ : h_ * std::max(first, kLeastPart);
}

void JointPart::BringToRest(double* all) const {
  for (Index column = 0; column < reduction_.cols(); ++column) {
    if (rest_at_s_[static_cast<std::size_t>(column)] > h_ + 2 * kInstantS) continue;
    for (Index row = 0; row < reduction_.rows(); ++row) {
      if (reduction_(row, column) != 0) all[places_[static_cast<std::size_t>(row)]] = 0;
    }
  }
}

}  // namespace tcs
