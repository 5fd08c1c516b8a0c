#include "simbody_bridge/model/zones.h"

#include <algorithm>
#include <numeric>

namespace tcs {
namespace {

// How far a model that is hit, or pushed harder than is trusted, may be past its zone before that
// is noticed: a step of 1 ms at 50 m/s.
constexpr double kMarginM = 0.05;
// Models that part have to be so much farther apart than models that stay apart.
constexpr double kPartingM = 0.1;
// The room of a model in a group, beside the room that it needs.
constexpr double kRoomInGroupM = 0.1;
constexpr double kMostRoomM = 1e6;

// The root of `i` in disjoint sets: `parents` has each element's parent, and a root is its own
// parent.
std::size_t RootOf(std::vector<std::size_t>& parents, std::size_t i) {
  while (parents[i] != i) {
    parents[i] = parents[parents[i]];
    i = parents[i];
  }
  return i;
}

}  // namespace

double Zones::RoomFor(const Mover& mover) const {
  return WayWithin(horizon_s_, mover.around.speed_mps) + kMarginM;
}

bool Zones::IsInTheWay(const Ball& other, const Mover& mover) const {
  return GapBetween(other, mover.around.ball) - kMarginM < RoomFor(mover);
}

// The models whose static shapes are near; a model of the group brings its own.
std::vector<int> Zones::BasesOf(const std::vector<std::size_t>& group,
                                std::span<const Mover> movers,
                                std::span<const StaticBall> statics) const {
  std::vector<int> bases;
  for (const StaticBall& one : statics) {
    const auto is_it = [&](std::size_t i) { return movers[i].model == one.model; };
    const auto has_it_near = [&](std::size_t i) {
      const double gap_m = GapBetween(one.ball, movers[i].around.ball);
      return gap_m - kMarginM < RoomFor(movers[i]) + kRoomInGroupM;
    };
    if (std::ranges::none_of(group, is_it) && std::ranges::any_of(group, has_it_near)) {
      bases.push_back(one.model);
    }
  }
  std::ranges::sort(bases);
  bases.erase(std::unique(bases.begin(), bases.end()), bases.end());
  return bases;
}

Grouping Zones::Group(std::span<const Mover> movers, std::span<const Ball> others,
                      std::span<const StaticBall> statics) const {
  const std::size_t count = movers.size();
  std::vector<std::size_t> parents(count);
  std::iota(parents.begin(), parents.end(), 0);
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      const double room = RoomFor(movers[i]) + RoomFor(movers[k]) +
                          (movers[i].group_before == movers[k].group_before ? kPartingM : 0);
      if (movers[i].unit == movers[k].unit ||
          GapBetween(movers[i].around.ball, movers[k].around.ball) < room) {
        parents[RootOf(parents, i)] = RootOf(parents, k);
      }
    }
  }
  Grouping grouping;
  std::vector<std::size_t> group_of(count), group_of_root(count, count);
  for (std::size_t i = 0; i < count; ++i) {
    std::size_t& group = group_of_root[RootOf(parents, i)];
    if (group == count) {
      group = grouping.groups.size();
      grouping.groups.emplace_back();
    }
    grouping.groups[group].push_back(i);
    group_of[i] = group;
  }
  for (const std::vector<std::size_t>& group : grouping.groups) {
    grouping.bases.push_back(BasesOf(group, movers, statics));
  }
  for (std::size_t i = 0; i < count; ++i) {
    const Ball& ball = movers[i].around.ball;
    const double own = RoomFor(movers[i]);
    double room = grouping.groups[group_of[i]].size() > 1 ? own + kRoomInGroupM : kMostRoomM;
    for (std::size_t k = 0; k < count; ++k) {
      if (group_of[k] == group_of[i]) continue;
      // Both models have the room that they need, and each has half of the room that is left.
      const double left = GapBetween(ball, movers[k].around.ball) - own - RoomFor(movers[k]);
      room = std::min(room, own + left / 2);
    }
    for (const Ball& other : others) room = std::min(room, GapBetween(ball, other) - kMarginM);
    const std::vector<std::size_t>& group = grouping.groups[group_of[i]];
    const std::vector<int>& bases = grouping.bases[group_of[i]];
    for (const StaticBall& one : statics) {
      const auto is_it = [&](std::size_t k) { return movers[k].model == one.model; };
      if (std::ranges::binary_search(bases, one.model) || std::ranges::any_of(group, is_it)) {
        continue;
      }
      room = std::min(room, GapBetween(ball, one.ball) - kMarginM);
    }
    grouping.zones.push_back({ball.center_m, ball.radius_m + room - kMarginM});
  }
  return grouping;
}

}  // namespace tcs
