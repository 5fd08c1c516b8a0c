#include "simbody_bridge/mujoco/joint_steps.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "simbody_bridge/joints/joint_groups.h"

namespace tcs {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

// Closed forms with springs cost the cube of the speeds that push each other, in each step.
constexpr std::size_t kMostSprungSpeeds = 12;
constexpr double kLeastPieceS = 1e-9;

}  // namespace

MujocoJointSteps::MujocoJointSteps(const Forest& forest, const mjModel& model,
                                   std::span<const int> bodies)
    : is_sprung_(static_cast<std::size_t>(model.nv), false),
      are_needed_(HasDampingOrFriction(forest)) {
  if (!are_needed_) return;
  const auto speed_of = [&](int body) {
    return model.body_dofadr[bodies[static_cast<std::size_t>(body)]];
  };
  const auto position_of = [&](int body) {
    return model.jnt_qposadr[model.body_jntadr[bodies[static_cast<std::size_t>(body)]]];
  };
  std::vector<int> leader(static_cast<std::size_t>(model.nv), -1);
  std::vector<double> multiplier(static_cast<std::size_t>(model.nv), 1);
  for (const ForestJoint& joint : forest.joints) {
    if (joint.leader < 0) continue;
    const Mimic& mimic = *joint.joint->mimic;
    const int of = forest.joints[static_cast<std::size_t>(joint.leader)].body;
    followers_.push_back({speed_of(joint.body), speed_of(of), position_of(joint.body),
                          position_of(of), mimic.multiplier, mimic.offset});
    const auto own = static_cast<std::size_t>(speed_of(joint.body));
    leader[own] = speed_of(of);
    multiplier[own] = mimic.multiplier;
  }
  for (const std::vector<std::size_t>& group : JointGroupsOf(forest)) {
    std::vector<std::size_t> speeds;
    std::vector<double> friction;
    for (const std::size_t body : group) {
      const int first = model.body_dofadr[bodies[body]];
      for (int i = 0; i < model.body_dofnum[bodies[body]]; ++i) {
        speeds.push_back(static_cast<std::size_t>(first + i));
        friction.push_back(FrictionOf(forest, body));
      }
    }
    const auto rows = static_cast<Eigen::Index>(speeds.size());
    MatrixXd reduction(rows, 0);
    for (const std::size_t own : speeds) {
      if (leader[own] >= 0) continue;
      reduction.conservativeResize(rows, reduction.cols() + 1);
      for (Eigen::Index row = 0; row < rows; ++row) {
        const std::size_t speed = speeds[static_cast<std::size_t>(row)];
        const bool follows = speed == own || leader[speed] == static_cast<int>(own);
        reduction(row, reduction.cols() - 1) = follows ? multiplier[speed] : 0;
      }
    }
    if (speeds.size() <= kMostSprungSpeeds) {
      for (const std::size_t speed : speeds) is_sprung_[speed] = true;
    }
    parts_.emplace_back(std::move(speeds), std::move(reduction),
                        Eigen::Map<const VectorXd>(friction.data(), rows), false);
    need_masses_ = need_masses_ || parts_.back().needs_masses();
  }
}

bool MujocoJointSteps::TakeStiffnessOf(int speed) const {
  return is_sprung_[static_cast<std::size_t>(speed)];
}

void MujocoJointSteps::FollowLeaders(double* speeds, double* positions) const {
  for (const Follower& of : followers_) {
    speeds[of.speed] = of.multiplier * speeds[of.leading_speed];
    if (positions == nullptr) continue;
    positions[of.position] = of.multiplier * positions[of.leading_position] + of.offset;
  }
}

void MujocoJointSteps::FindMass(const mjModel& model, const mjData& data) {
  mass_.resize(model.nv, model.nv);
  mj_fullM(&model, mass_.data(), data.qM);
}

// From the start with `way_` and `speed_`.
bool MujocoJointSteps::Go(const mjModel& model, mjData* data, const Find& find) {
  positions_ = start_;
  mj_integratePos(&model, positions_.data(), way_.data(), 1);
  std::copy(speed_.begin(), speed_.end(), data->qvel);
  if (!find(positions_.data())) return false;
  if (need_masses_) FindMass(model, *data);
  return true;
}

bool MujocoJointSteps::Try(const mjModel& model, mjData* data, double h, const Find& find) {
  const auto spread = [this](const JointPart& part, const JointMotion& motion) {
    part.Scatter(motion, way_.data(), speed_.data());
  };
  for (JointPart& part : parts_) spread(part, part.Middle(h));
  if (!Go(model, data, find)) return false;
  for (JointPart& part : parts_) {
    spread(part, part.End(part.NeededMassIn(mass_), part.Gather(data->qacc_smooth)));
  }
  if (!Go(model, data, find)) return false;
  for (JointPart& part : parts_) {
    spread(part, part.Arrive(part.NeededMassIn(mass_), part.Gather(data->qacc_smooth)));
  }
  return true;
}

bool MujocoJointSteps::Step(const mjModel& model, mjData* data, const Slopes& slopes,
                            const Find& find) {
  const auto speeds = static_cast<std::size_t>(model.nv);
  way_.assign(speeds, 0);
  speed_.assign(data->qvel, data->qvel + speeds);
  start_.assign(data->qpos, data->qpos + model.nq);
  FollowLeaders(speed_.data(), start_.data());
  double left_s = model.opt.timestep;
  for (int piece = 1; left_s > 0; ++piece) {
    std::fill(way_.begin(), way_.end(), 0);
    if (!Go(model, data, find)) return false;
    if (!need_masses_) FindMass(model, *data);
    for (JointPart& part : parts_) {
      part.Begin({.mass = part.MassIn(mass_),
                  .speed = part.Gather(data->qvel),
                  .rate = part.Gather(data->qacc_smooth),
                  .by_speed = part.Gather(slopes.by_speed.data()),
                  .by_coordinate = part.Gather(slopes.by_coordinate.data()),
                  .longest_s = left_s});
    }
    double h = left_s;
    if (!Try(model, data, h, find)) return false;
    for (int i = 0; i < kMostEventTries && piece < kMostStepPieces; ++i) {
      double event_s = h;
      for (JointPart& part : parts_) event_s = std::min(event_s, part.FirstEvent());
      event_s = std::max(event_s, kLeastPieceS);
      if (event_s >= h) break;
      h = event_s;
      if (!Try(model, data, h, find)) return false;
    }
    for (const JointPart& part : parts_) part.BringToRest(speed_.data());
    mj_integratePos(&model, start_.data(), way_.data(), 1);
    FollowLeaders(speed_.data(), start_.data());
    left_s -= h;
  }
  std::copy(start_.begin(), start_.end(), data->qpos);
  std::copy(speed_.begin(), speed_.end(), data->qvel);
  return true;
}

}  // namespace tcs
