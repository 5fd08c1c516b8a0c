#include "simbody_bridge/simbody/tree/servo_steps.h"

#include <Eigen/Cholesky>
#include <algorithm>

#include "simbody_bridge/simbody/tree/mimics.h"

namespace tcs {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

// What closed forms cost grows with the cube of a model's speeds: beyond this short steps are
// cheaper.
constexpr std::size_t kMostSpeeds = 40;

bool Holds(const JointDrive& drive) { return drive.stiffness > 0 || drive.damping > 0; }

VectorXd Gather(const std::vector<std::size_t>& places, const double* all) {
  VectorXd some(static_cast<Eigen::Index>(places.size()));
  for (std::size_t i = 0; i < places.size(); ++i)
    some[static_cast<Eigen::Index>(i)] = all[places[i]];
  return some;
}

void Scatter(const VectorXd& some, const std::vector<std::size_t>& places, double* all) {
  for (std::size_t i = 0; i < places.size(); ++i)
    all[places[i]] = some[static_cast<Eigen::Index>(i)];
}

template <class Numbers>
void Append(const Numbers& numbers, std::vector<double>* to) {
  to->insert(to->end(), numbers.data(), numbers.data() + numbers.size());
}

// Takes as many numbers as it has.
template <class Numbers>
const double* Take(const double* from, Numbers* numbers) {
  std::copy_n(from, numbers->size(), numbers->data());
  return from + numbers->size();
}

}  // namespace

bool ServoSteps::AreFor(const SimbodyTree& tree, std::span<const Wrench> acting) {
  const Forest& forest = tree.forest();
  bool has_servo = false;
  for (std::size_t i = 0; i < forest.joints.size() && !has_servo; ++i) {
    has_servo =
        forest.joints[i].body != kWorldBody && Holds(DriveOfJoint(acting, forest.links.size(), i));
  }
  if (!has_servo) return false;
  std::size_t speeds = 0;
  for (std::size_t body = 0; body < forest.bodies.size(); ++body) {
    if (body > 0 && forest.model_of_body[body] != forest.model_of_body[body - 1]) speeds = 0;
    speeds += tree.slots()[body].u_count;
    if (speeds > kMostSpeeds) return false;
  }
  return true;
}

void ServoSteps::TakeControlled(SimbodyTree& tree, ModelLoads& loads, IslandStep& step,
                                double accuracy, double limit_s) {
  ControlledSteps::TakeControlled(tree, loads, step, accuracy, limit_s);
  WriteCourse(tree, step);
}

// The bodies of a model follow each other.
void ServoSteps::Divide(const SimbodyTree& tree) {
  const Forest& forest = tree.forest();
  const auto slots = tree.slots();
  coordinates_ = 0;
  for (const StateSlots& of_body : slots) coordinates_ += of_body.q_count;
  for (std::size_t body = 0; body < slots.size(); ++body) {
    if (body == 0 || forest.model_of_body[body] != forest.model_of_body[body - 1]) {
      parts_.emplace_back();
    }
    for (std::size_t i = 0; i < slots[body].u_count; ++i) {
      parts_.back().speeds.push_back(slots[body].u - coordinates_ + i);
    }
  }
  MatrixXd all;
  Reduce(tree, &all);
  for (Part& part : parts_) {
    const auto rows = static_cast<Eigen::Index>(part.speeds.size());
    MatrixXd& own = part.reduction;
    own.resize(rows, 0);
    for (Eigen::Index column = 0; column < all.cols(); ++column) {
      const VectorXd whole = all.col(column), of_part = Gather(part.speeds, whole.data());
      if (of_part.isZero(0)) continue;
      own.conservativeResize(rows, own.cols() + 1);
      own.rightCols(1) = of_part;
    }
  }
}

void ServoSteps::Begin(SimbodyTree& tree, ModelLoads& loads, IslandStep& step) {
  if (parts_.empty()) Divide(tree);
  const std::size_t size = step.from.size();
  for (std::vector<double>* state :
       {&step.to, &step.from_rate, &state_, &middle_rate_, &end_rate_, &error_}) {
    state->resize(size);
  }
  for (std::vector<double>* speeds : {&way_, &speed_}) speeds->resize(size - coordinates_);
  for (std::vector<double>* turns : {&turn_, &middle_turn_, &end_turn_}) {
    turns->resize(coordinates_);
  }
  step.course.clear();
  tree.EvaluateOrRecall(step.from, loads.At(step, 0), step.from_rate.data());
  Linearise(tree, loads.At(step, 0), step);
}

// Joints that mimic others move as these do: the mass is that of both.
void ServoSteps::Linearise(SimbodyTree& tree, std::span<const Wrench> acting,
                           const IslandStep& step) {
  tree.Linearise(step.from, acting, &mass_, &by_speed_, &by_coordinate_);
  for (Part& part : parts_) {
    const auto size = static_cast<Eigen::Index>(part.speeds.size());
    MatrixXd mass(size, size);
    for (Eigen::Index i = 0; i < size; ++i) {
      for (Eigen::Index k = 0; k < size; ++k) {
        mass(i, k) = mass_(static_cast<int>(part.speeds[static_cast<std::size_t>(i)]),
                           static_cast<int>(part.speeds[static_cast<std::size_t>(k)]));
      }
    }
    const MatrixXd& reduction = part.reduction;
    const MatrixXd by_mass =
        reduction *
        (reduction.transpose() * mass * reduction).llt().solve(MatrixXd(reduction.transpose()));
    ServoStart& start = part.motion.start();
    start.stiffness = by_mass * Gather(part.speeds, by_coordinate_.data()).asDiagonal();
    start.damping = by_mass * Gather(part.speeds, by_speed_.data()).asDiagonal();
    start.speed = Gather(part.speeds, &step.from[coordinates_]);
    start.rate = Gather(part.speeds, &step.from_rate[coordinates_]);
  }
}

// `way_` and `speed_` from the beginning on.
void ServoSteps::Place(const SimbodyTree& tree, const IslandStep& step, std::span<double> state) {
  tree.CoordinateRates(step.from, way_, turn_);
  for (std::size_t i = 0; i < coordinates_; ++i) state[i] = step.from[i] + turn_[i];
  std::copy(speed_.begin(), speed_.end(), &state[coordinates_]);
}

// Coordinates of a base that turns do not grow as the speeds do: what remains of their rates is
// taken as by Kutta's method.
void ServoSteps::Try(SimbodyTree& tree, ModelLoads& loads, IslandStep& step, double h) {
  const auto spread = [this](const Part& part, const JointMotion& motion) {
    Scatter(motion.way, part.speeds, way_.data());
    Scatter(motion.speed, part.speeds, speed_.data());
  };
  const auto find_turn = [&](const std::vector<double>& rate, std::vector<double>* turn) {
    tree.CoordinateRates(step.from, speed_, *turn);
    for (std::size_t i = 0; i < coordinates_; ++i) (*turn)[i] = rate[i] - (*turn)[i];
  };
  for (Part& part : parts_) spread(part, part.motion.Middle(h));
  Place(tree, step, state_);
  tree.Evaluate(state_, loads.At(step, h / 2), middle_rate_.data());
  find_turn(middle_rate_, &middle_turn_);

  for (Part& part : parts_) {
    spread(part, part.motion.End(Gather(part.speeds, &middle_rate_[coordinates_])));
  }
  Place(tree, step, state_);
  for (std::size_t i = 0; i < coordinates_; ++i) state_[i] += h * 2 * middle_turn_[i];
  tree.Evaluate(state_, loads.At(step, h), end_rate_.data());
  find_turn(end_rate_, &end_turn_);

  for (Part& part : parts_) {
    spread(part, part.motion.Arrive(Gather(part.speeds, &end_rate_[coordinates_])));
  }
  Place(tree, step, step.to);
  for (std::size_t i = 0; i < coordinates_; ++i) {
    step.to[i] += h / 6 * (4 * middle_turn_[i] + end_turn_[i]);
  }
}

double ServoSteps::ErrorOf(const SimbodyTree& tree, const IslandStep& step, double h) {
  for (const Part& part : parts_) {
    Scatter(part.motion.error().way, part.speeds, way_.data());
    Scatter(part.motion.error().speed, part.speeds, &error_[coordinates_]);
  }
  tree.CoordinateRates(step.from, way_, turn_);
  for (std::size_t i = 0; i < coordinates_; ++i) {
    error_[i] = turn_[i] + h / 6 * (end_turn_[i] - 2 * middle_turn_[i]);
  }
  const auto slots = tree.slots();
  return GreatestError(
      step, [this](std::size_t i) { return error_[i]; }, slots.size(),
      [&](std::size_t body) { return slots[body]; });
}

// Springs, dampers and the push of each part. Then how far all that leads off from where the step
// ends: coordinates, their rates, and speeds.
void ServoSteps::WriteCourse(const SimbodyTree& tree, IslandStep& step) {
  for (const Part& part : parts_) {
    const ServoPush push = part.motion.PushUntil(Gather(part.speeds, &step.to_rate[coordinates_]));
    const JointMotion along = part.motion.Along(push);
    Scatter(along.way, part.speeds, way_.data());
    Scatter(along.speed, part.speeds, speed_.data());
    Append(part.motion.start().stiffness, &step.course);
    Append(part.motion.start().damping, &step.course);
    Append(push.f1, &step.course);
    Append(push.f2, &step.course);
  }
  Place(tree, step, state_);
  tree.CoordinateRates(step.from, speed_, turn_);
  for (std::size_t i = 0; i < coordinates_; ++i) step.course.push_back(step.to[i] - state_[i]);
  for (std::size_t i = 0; i < coordinates_; ++i) step.course.push_back(step.to_rate[i] - turn_[i]);
  for (std::size_t i = coordinates_; i < state_.size(); ++i) {
    step.course.push_back(step.to[i] - state_[i]);
  }
}

void ServoSteps::Within(const SimbodyTree& tree, const IslandStep& step, double after_s,
                        std::vector<double>* state) {
  state->resize(step.from.size());
  const double* course = step.course.data();
  for (const Part& part : parts_) {
    const auto size = static_cast<Eigen::Index>(part.speeds.size());
    start_.stiffness.resize(size, size);
    start_.damping.resize(size, size);
    push_.f1.resize(size);
    push_.f2.resize(size);
    push_.seconds = step.length_s;
    course = Take(course, &start_.stiffness);
    course = Take(course, &start_.damping);
    course = Take(course, &push_.f1);
    course = Take(course, &push_.f2);
    start_.speed = Gather(part.speeds, &step.from[coordinates_]);
    start_.rate = Gather(part.speeds, &step.from_rate[coordinates_]);
    const JointMotion motion = MotionAfter(start_, push_, after_s, &finder_);
    Scatter(motion.way, part.speeds, way_.data());
    Scatter(motion.speed, part.speeds, speed_.data());
  }
  Place(tree, step, *state);
  const double d = after_s / step.length_s;
  const double to = d * d * (3 - 2 * d), to_rate = -step.length_s * d * d * (1 - d);
  for (std::size_t i = 0; i < coordinates_; ++i) {
    (*state)[i] += to * course[i] + to_rate * course[coordinates_ + i];
  }
  for (std::size_t i = coordinates_; i < state->size(); ++i) {
    (*state)[i] += to * course[coordinates_ + i];
  }
}

}  // namespace tcs
