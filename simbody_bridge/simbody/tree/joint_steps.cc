#include "simbody_bridge/simbody/tree/joint_steps.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "simbody_bridge/joints/joint_groups.h"
#include "simbody_bridge/simbody/tree/mimics.h"

namespace tcs {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

// The cost of closed forms with springs grows with the cube of the speeds that push each other:
// beyond this short steps are cheaper. Dampers alone have no such limit.
constexpr std::size_t kMostSpeeds = 10;

bool IsSprung(const JointDrive& drive) { return drive.stiffness > 0; }
bool Holds(const JointDrive& drive) { return IsSprung(drive) || drive.damping > 0; }

// The effort ratio of each joint, 0 where it has no drive.
void FindEffortRatios(const SimbodyTree& tree, std::span<const Wrench> acting,
                      std::span<const double> state, std::vector<double>* ratios) {
  const Forest& forest = tree.forest();
  ratios->assign(forest.joints.size(), 0);
  for (std::size_t i = 0; i < forest.joints.size(); ++i) {
    const ForestJoint& joint = forest.joints[i];
    if (joint.body == kWorldBody) continue;
    const StateSlots& of = tree.slots()[static_cast<std::size_t>(joint.body)];
    if (of.u_count != 1) continue;
    const JointDrive drive = DriveOfJoint(acting, forest.links.size(), i);
    (*ratios)[i] = EffortOf(drive, kNoLimit, state[of.q], state[of.u]) / joint.joint->limits.effort;
  }
}

template <class Numbers>
void Append(const Numbers& numbers, std::vector<double>* to) {
  to->insert(to->end(), numbers.data(), numbers.data() + numbers.size());
}

// Takes as many numbers as `numbers` has.
template <class Numbers>
const double* Take(const double* from, Numbers* numbers) {
  std::copy_n(from, numbers->size(), numbers->data());
  return from + numbers->size();
}

}  // namespace

bool JointSteps::IsLarge(const JointPart& part) const { return part.size() > kMostSpeeds; }

JointSteps::Fit JointSteps::FitOf(const SimbodyTree& tree, std::span<const Wrench> acting) {
  if (!is_divided_) Divide(tree);
  const Forest& forest = tree.forest();
  const bool is_large = std::any_of(parts_.begin(), parts_.end(),
                                    [this](const JointPart& part) { return IsLarge(part); });
  bool holds = has_own_, is_sprung = false;
  for (std::size_t i = 0; i < forest.joints.size() && (!holds || is_large); ++i) {
    if (forest.joints[i].body == kWorldBody) continue;
    const JointDrive drive = DriveOfJoint(acting, forest.links.size(), i);
    holds = holds || Holds(drive);
    is_sprung = is_sprung || IsSprung(drive);
  }
  if (!holds) return Fit::kNotNeeded;
  return is_large && is_sprung ? Fit::kTooLarge : Fit::kFits;
}

void JointSteps::TakeControlled(SimbodyTree& tree, ModelLoads& loads, IslandStep& step,
                                double accuracy, double limit_s) {
  ControlledSteps::TakeControlled(tree, loads, step, accuracy, limit_s);
  WriteCourse(tree, step);
}

void JointSteps::TakeWhole(SimbodyTree& tree, ModelLoads& loads, IslandStep& step) {
  piece_ = step;
  for (int piece = 0; piece < kMostStepPieces; ++piece) {
    piece_.length_s = piece_.try_s = piece_.limit.seconds();
    Begin(tree, loads, piece_);
    Try(tree, loads, piece_, piece_.length_s);
    if (piece + 1 < kMostStepPieces) EndAtEvent(tree, loads, piece_);
    tree.Project(piece_.to);
    if (piece_.length_s == piece_.limit.seconds()) break;
    const auto length = VirtualDuration::Nanoseconds(std::llround(piece_.length_s * 1e9));
    piece_.at = piece_.at + length;
    piece_.limit = piece_.limit - length;
    std::swap(piece_.from, piece_.to);
  }
  step.length_s = step.limit.seconds();
  step.course.clear();
  step.from_rate.assign(step.from.size(), 0);
  step.to = piece_.to;
}

void JointSteps::Divide(const SimbodyTree& tree) {
  const Forest& forest = tree.forest();
  const auto slots = tree.slots();
  is_divided_ = true;
  has_own_ = HasDampingOrFriction(forest);
  coordinates_ = 0;
  for (const StateSlots& of_body : slots) coordinates_ += of_body.q_count;
  MatrixXd all;
  Reduce(tree, &all);
  for (const std::vector<std::size_t>& bodies : JointGroupsOf(forest)) {
    std::vector<std::size_t> speeds;
    std::vector<double> friction;
    for (const std::size_t body : bodies) {
      for (std::size_t i = 0; i < slots[body].u_count; ++i) {
        speeds.push_back(slots[body].u - coordinates_ + i);
        friction.push_back(FrictionOf(forest, body));
      }
    }
    const auto rows = static_cast<Eigen::Index>(speeds.size());
    MatrixXd own(rows, 0);
    for (Eigen::Index column = 0; column < all.cols(); ++column) {
      const VectorXd of_part = all.col(column)(speeds);
      if (of_part.isZero(0)) continue;
      own.conservativeResize(rows, own.cols() + 1);
      own.rightCols(1) = of_part;
    }
    parts_.emplace_back(std::move(speeds), std::move(own),
                        Eigen::Map<const VectorXd>(friction.data(), rows), true);
    needs_masses_ = needs_masses_ || parts_.back().needs_masses();
  }
}

void JointSteps::Begin(SimbodyTree& tree, ModelLoads& loads, IslandStep& step) {
  if (!is_divided_) Divide(tree);
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
  tree.Linearise(step.from, loads.At(step, 0), &mass_, &by_speed_, &by_coordinate_);
  for (JointPart& part : parts_) {
    JointPart::Start start{.mass = part.MassIn(mass_),
                           .speed = part.Gather(&step.from[coordinates_]),
                           .rate = part.Gather(&step.from_rate[coordinates_]),
                           .by_speed = part.Gather(by_speed_.data()),
                           .by_coordinate = part.Gather(by_coordinate_.data()),
                           .longest_s = std::min(step.try_s, step.limit.seconds())};
    // In a large part only stops are springs.
    if (IsLarge(part)) start.by_coordinate.setZero();
    part.Begin(start);
  }
}

// Finds the mass matrix for the parts that need it.
void JointSteps::FindMass(SimbodyTree& tree, std::span<const double> state) {
  if (needs_masses_) tree.FindMass(state, &mass_);
}

// The state after `way_` and `speed_` from the step's beginning on.
void JointSteps::Place(const SimbodyTree& tree, const IslandStep& step, std::span<double> state) {
  tree.CoordinateRates(step.from, way_, turn_);
  for (std::size_t i = 0; i < coordinates_; ++i) state[i] = step.from[i] + turn_[i];
  std::copy(speed_.begin(), speed_.end(), &state[coordinates_]);
}

// Coordinates of a base that turns do not grow as the speeds do: the rest of their rates is taken
// as by Kutta's method.
void JointSteps::Try(SimbodyTree& tree, ModelLoads& loads, IslandStep& step, double h) {
  const auto spread = [this](const JointPart& part, const JointMotion& motion) {
    part.Scatter(motion, way_.data(), speed_.data());
  };
  const auto find_turn = [&](const std::vector<double>& rate, std::vector<double>* turn) {
    tree.CoordinateRates(step.from, speed_, *turn);
    for (std::size_t i = 0; i < coordinates_; ++i) (*turn)[i] = rate[i] - (*turn)[i];
  };
  for (JointPart& part : parts_) spread(part, part.Middle(h));
  Place(tree, step, state_);
  tree.Evaluate(state_, loads.At(step, h / 2), middle_rate_.data());
  FindMass(tree, state_);
  find_turn(middle_rate_, &middle_turn_);

  for (JointPart& part : parts_) {
    spread(part, part.End(part.NeededMassIn(mass_), part.Gather(&middle_rate_[coordinates_])));
  }
  Place(tree, step, state_);
  for (std::size_t i = 0; i < coordinates_; ++i) state_[i] += h * 2 * middle_turn_[i];
  tree.Evaluate(state_, loads.At(step, h), end_rate_.data());
  FindMass(tree, state_);
  find_turn(end_rate_, &end_turn_);

  for (JointPart& part : parts_) {
    spread(part, part.Arrive(part.NeededMassIn(mass_), part.Gather(&end_rate_[coordinates_])));
  }
  Place(tree, step, step.to);
  for (std::size_t i = 0; i < coordinates_; ++i) {
    step.to[i] += h / 6 * (4 * middle_turn_[i] + end_turn_[i]);
  }
}

// A step that has been taken ends where the first joint comes to rest, or breaks away.
void JointSteps::EndAtEvent(SimbodyTree& tree, ModelLoads& loads, IslandStep& step) {
  const auto has_friction = [](const JointPart& part) { return part.has_friction(); };
  if (std::none_of(parts_.begin(), parts_.end(), has_friction)) return;
  if (!std::isfinite(step.to.back())) return;
  for (int i = 0; i < kMostEventTries; ++i) {
    double event_s = step.length_s;
    for (JointPart& part : parts_) event_s = std::min(event_s, part.FirstEvent());
    event_s = WholeNanoseconds(std::max(event_s, kShortestStepS));
    if (event_s >= step.length_s) break;
    step.length_s = event_s;
    Try(tree, loads, step, event_s);
  }
  for (const JointPart& part : parts_) part.BringToRest(&step.to[coordinates_]);
}

double JointSteps::ErrorOf(const SimbodyTree& tree, const IslandStep& step, double h) {
  for (const JointPart& part : parts_) {
    part.Scatter(part.motion().error(), way_.data(), &error_[coordinates_]);
  }
  tree.CoordinateRates(step.from, way_, turn_);
  for (std::size_t i = 0; i < coordinates_; ++i) {
    error_[i] = turn_[i] + h / 6 * (end_turn_[i] - 2 * middle_turn_[i]);
  }
  const auto slots = tree.slots();
  return GreatestError(
      step, [this](std::size_t i) { return error_[i]; }, slots.size(),
      [&](std::size_t body) { return slots[body]; }, &worst_body_);
}

// The motion goes on as if nothing but springs and dampers changed the push on the joints: the
// prediction takes none of the engine's rates.
double JointSteps::PredictKink(const SimbodyTree& tree, ModelLoads& loads, const IslandStep& step,
                               double h) {
  FindEffortRatios(tree, loads.At(step, 0), step.from, &ratios_);
  crossings_.Begin(ratios_);
  return crossings_.Predict(h, [&](double after_s, std::vector<double>* ratios) {
    for (JointPart& part : parts_) {
      part.Middle(after_s);
      part.Scatter(part.motion().ahead(), way_.data(), speed_.data());
    }
    Place(tree, step, state_);
    FindEffortRatios(tree, loads.At(step, after_s), state_, ratios);
  });
}

double JointSteps::LateKink(const SimbodyTree& tree, ModelLoads& loads, const IslandStep& step,
                            double h) {
  FindEffortRatios(tree, loads.At(step, h), step.to, &ratios_);
  return crossings_.Late(h, ratios_);
}

double JointSteps::FirstKink(const SimbodyTree& tree, ModelLoads& loads, const IslandStep& step,
                             double h) {
  FindEffortRatios(tree, loads.At(step, h), step.to, &ratios_);
  return crossings_.First(h, ratios_);
}

// Writes how each part began, its springs and dampers, and its push. Then how far all that leads
// off from where the step ends: coordinates, their rates, and speeds.
void JointSteps::WriteCourse(SimbodyTree& tree, IslandStep& step) {
  FindMass(tree, step.to);
  for (const JointPart& part : parts_) {
    const VectorXd end_rate =
        part.Rate(part.NeededMassIn(mass_), part.Gather(&step.to_rate[coordinates_]));
    const ServoPush push = part.motion().PushUntil(end_rate);
    const JointMotion along = part.motion().Along(push);
    part.Scatter(along, way_.data(), speed_.data());
    const ServoStart& start = part.motion().start();
    Append(start.speed, &step.course);
    Append(start.rate, &step.course);
    step.course.push_back(start.has_springs ? 1 : 0);
    if (start.has_springs) {
      Append(start.stiffness, &step.course);
      Append(start.damping, &step.course);
    } else {
      step.course.push_back(static_cast<double>(start.modes.rates.size()));
      Append(start.modes.rates, &step.course);
      Append(start.modes.onto, &step.course);
      Append(start.modes.from, &step.course);
    }
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

void JointSteps::Within(const SimbodyTree& tree, const IslandStep& step, double after_s,
                        std::vector<double>* state) {
  state->resize(step.from.size());
  const double* course = step.course.data();
  for (const JointPart& part : parts_) {
    const auto size = static_cast<Eigen::Index>(part.size());
    start_.speed.resize(size);
    start_.rate.resize(size);
    push_.f1.resize(size);
    push_.f2.resize(size);
    push_.seconds = step.length_s;
    course = Take(course, &start_.speed);
    course = Take(course, &start_.rate);
    start_.has_springs = *course++ != 0;
    if (start_.has_springs) {
      start_.stiffness.resize(size, size);
      start_.damping.resize(size, size);
      course = Take(course, &start_.stiffness);
      course = Take(course, &start_.damping);
    } else {
      const auto modes = static_cast<Eigen::Index>(*course++);
      start_.modes.rates.resize(modes);
      start_.modes.onto.resize(size, modes);
      start_.modes.from.resize(modes, size);
      course = Take(course, &start_.modes.rates);
      course = Take(course, &start_.modes.onto);
      course = Take(course, &start_.modes.from);
    }
    course = Take(course, &push_.f1);
    course = Take(course, &push_.f2);
    const JointMotion motion = MotionAfter(start_, push_, after_s);
    part.Scatter(motion, way_.data(), speed_.data());
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
