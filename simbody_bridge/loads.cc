#include "simbody_bridge/loads.h"

#include <algorithm>

#include "simbody_bridge/frames.h"
#include "simbody_bridge/lag.h"

namespace tcs {

Loads::Loads(const WorldSpec& world, const std::vector<std::vector<int>>& islands)
    : wind_(world.wind) {
  for (const std::vector<int>& bodies : islands) {
    std::vector<DragSpec>& drags = drags_.emplace_back();
    for (const int body : bodies) {
      drags.push_back(world.bodies[static_cast<std::size_t>(body)].drag);
    }
    if (std::ranges::all_of(drags, [](const DragSpec& drag) { return drag == DragSpec{}; })) {
      drags.clear();
    }
  }
}

Load Loads::At(const IslandStep& step, std::size_t place, double after_s,
               const BodyState& body) const {
  if (IsConstant(step, place)) return LoadOf(step.wrenches[place]);
  if (step.remainders.empty()) return Sum(step, place, 0, body, after_s);
  const Wrench& command = step.wrenches[place];
  const double left = ShareLeft(command, step.remainders[place], step.at);
  return Sum(step, place, ShareLeftAfter(command, left, after_s), body, after_s);
}

Load Loads::MeanOver(const IslandStep& step, std::size_t place, double seconds,
                     const BodyState& body) const {
  if (IsConstant(step, place)) return LoadOf(step.wrenches[place]);
  if (step.remainders.empty()) return Sum(step, place, 0, body, 0);
  const double left = MeanShareLeft(step.wrenches[place], step.remainders[place], step.at, seconds);
  return Sum(step, place, left, body, 0);
}

Load Loads::Sum(const IslandStep& step, std::size_t place, double share_left, const BodyState& body,
                double after_s) const {
  const Wrench& command = step.wrenches[place];
  Load in_world, in_body;
  AddTo(command.in_body_frame ? &in_body : &in_world, LoadOf(command), 1 - share_left);
  if (share_left > 0) {
    AddTo(&in_world, step.remainders[place].in_world, share_left);
    AddTo(&in_body, step.remainders[place].in_body, share_left);
  }
  if (in_body != Load{}) {
    const auto& q = body.orientation_xyzw;
    AddTo(&in_world, {InWorld(q, in_body.force_n), InWorld(q, in_body.torque_nm)}, 1);
  }
  const std::vector<DragSpec>& drags = drags_[static_cast<std::size_t>(step.island)];
  if (!drags.empty() && drags[place] != DragSpec{}) {
    AddTo(&in_world, DragOn(drags[place], body, wind_.At(step.at, after_s)), 1);
  }
  return in_world;
}

}  // namespace tcs
