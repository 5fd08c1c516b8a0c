#include "simbody_bridge/simbody/tree/servo_kinks.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tcs {
namespace {

// How much further on the next step begins, of what a servo can give.
constexpr double kBehind = 1e-5;

void FindAsked(const Forest& forest, std::span<const StateSlots> slots,
               std::span<const Wrench> acting, std::span<const double> state,
               std::vector<double>* asked) {
  asked->assign(forest.joints.size(), 0);
  for (std::size_t i = 0; i < forest.joints.size(); ++i) {
    const ForestJoint& joint = forest.joints[i];
    if (joint.body == kWorldBody) continue;
    const JointDrive drive = DriveOfJoint(acting, forest.links.size(), i);
    const StateSlots& of = slots[static_cast<std::size_t>(joint.body)];
    if (of.u_count != 1) continue;
    (*asked)[i] = EffortOf(drive, kNoLimit, state[of.q], state[of.u]) / joint.joint->limits.effort;
  }
}

}  // namespace

void ServoKinks::Begin(const SimbodyTree& tree, std::span<const Wrench> acting,
                       std::span<const double> state) {
  FindAsked(tree.forest(), tree.slots(), acting, state, &asked_);
  slopes_.assign(asked_.size(), 0);
  before_s_ = 0;
  limit_ = 0;
}

double ServoKinks::First(const SimbodyTree& tree, std::span<const Wrench> acting,
                         std::span<const double> state, double h) {
  FindAsked(tree.forest(), tree.slots(), acting, state, &asked_at_end_);
  double first_s = h;
  for (std::size_t i = 0; i < asked_.size(); ++i) {
    double& slope = slopes_[i];
    if (h < before_s_) slope = (asked_before_[i] - asked_at_end_[i]) / (before_s_ - h);
    if (!std::isfinite(asked_at_end_[i])) continue;
    for (const double limit : {-1.0, 1.0}) {
      const double start = asked_[i] - limit, end = asked_at_end_[i] - limit;
      if (start == 0 || (start > 0) == (end > 0)) continue;
      const double behind = end > 0 ? kBehind : -kBehind;
      double at_s = h * (behind - start) / (end - start);
      const double by_slope = h - (end - behind) / slope;
      if (by_slope > 0 && by_slope < at_s) at_s = by_slope;
      if (at_s >= first_s) continue;
      first_s = at_s;
      joint_ = i;
      limit_ = limit;
    }
  }
  std::swap(asked_before_, asked_at_end_);
  before_s_ = h;
  return first_s;
}

double ServoKinks::Missed(const SimbodyTree& tree, std::span<const Wrench> acting,
                          std::span<const double> state, double h) {
  if (limit_ == 0) return h;
  FindAsked(tree.forest(), tree.slots(), acting, state, &asked_at_end_);
  const double start = asked_[joint_] - limit_, end = asked_at_end_[joint_] - limit_;
  if ((start > 0) != (end > 0)) return h;
  const double behind = start > 0 ? -kBehind : kBehind;
  const double at_s = h + (behind - end) / slopes_[joint_];
  return at_s > h ? at_s : h;
}

}  // namespace tcs
