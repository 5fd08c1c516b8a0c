#include "simbody_bridge/body_islands.h"

#include <fmt/format.h>

#include <algorithm>
#include <exception>

#include "simbody_bridge/require.h"
#include "simbody_bridge/take_steps.h"
#include "simbody_bridge/world_check.h"

namespace tcs {
namespace {

// As many steps as an engine evaluates side by side.
constexpr std::size_t kStepsAtOnce = 32;

}  // namespace

BodyIslands::BodyIslands(const WorldSpec& world, Dynamics::Work& work)
    : members_(IslandsOf(world)), places_(world.bodies.size()) {
  if (!members_.empty()) engine_ = MakeEngine(world, members_);
  for (const BodySpec& body : world.bodies) names_.push_back(body.name);
  for (std::size_t i = 0; i < members_.size(); ++i) {
    const int bodies = static_cast<int>(members_[i].size());
    islands_.emplace_back(static_cast<int>(i), bodies, *engine_, work);
    for (int place = 0; place < bodies; ++place) {
      places_[static_cast<std::size_t>(members_[i][static_cast<std::size_t>(place)])] = {i, place};
    }
  }
}

void BodyIslands::UseTeam(const WorldSpec& world, Team& team) {
  if (engine_ == nullptr || !engine_->may_be_doubled() || team.workers() == 1) return;
  team_ = &team;
  further_engines_.clear();
  while (further_engines_.size() + 1 < team.workers()) {
    further_engines_.push_back(MakeEngine(world, members_));
  }
}

const BodyIslands::Place& BodyIslands::PlaceOf(int body) const {
  Require(body >= 0 && body < static_cast<int>(places_.size()), "no such body in the dynamics");
  return places_[static_cast<std::size_t>(body)];
}

void BodyIslands::Apply(int body, const Wrench& wrench, VirtualTime t, VirtualTime now) {
  const Place place = PlaceOf(body);
  CheckWrench(names_[static_cast<std::size_t>(body)], wrench);
  Island& island = islands_[place.island];
  if (island.CommandsUntil(now) >= kMostPending) {
    moving_.assign(1, place.island);
    Reach(now, now);
  }
  island.Settle(now);
  island.Apply(place.place, wrench, t);
}

void BodyIslands::Read(VirtualTime t, VirtualTime now, std::span<const int> bodies,
                       std::span<BodyState> states) {
  moving_.clear();
  for (const int body : bodies) moving_.push_back(PlaceOf(body).island);
  Reach(t, now);
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const Place& place = PlaceOf(bodies[i]);
    islands_[place.island].StateAt(t, &state_);
    CheckState(*engine_, static_cast<int>(place.island), state_, t,
               [this](int island, auto state) { return NameOf(island, state); });
    states[i] = engine_->Read(static_cast<int>(place.island), place.place, state_);
  }
}

// Takes all steps that lead to `t` of the islands in `moving_`: the next step of each island, until
// none needs any more.
void BodyIslands::Reach(VirtualTime t, VirtualTime now) {
  std::sort(moving_.begin(), moving_.end());
  moving_.erase(std::unique(moving_.begin(), moving_.end()), moving_.end());
  for (const std::size_t island : moving_) islands_[island].Settle(now);
  for (int round = 1;; ++round) {
    if (is_interrupted_ && round % kStepsBetweenLooks == 0 && is_interrupted_())
      throw DynamicsInterrupted();
    steps_.clear();
    std::size_t left = 0;
    for (const std::size_t island : moving_) {
      IslandStep* step = islands_[island].NextStepTo(t);
      if (step == nullptr) continue;
      moving_[left++] = island;
      steps_.push_back(step);
    }
    moving_.resize(left);
    if (steps_.empty()) return;
    TakeAll();
    for (const std::size_t island : moving_) {
      islands_[island].Took();
      islands_[island].Settle(now);
    }
  }
}

void BodyIslands::TakeAll() {
  const WhoDiverged who = [this](int island, auto state) { return NameOf(island, state); };
  const std::span<IslandStep* const> all = steps_;
  if (team_ == nullptr || all.size() <= kStepsAtOnce) {
    TakeSteps(*engine_, all, who);
    return;
  }
  const std::size_t pieces = (all.size() + kStepsAtOnce - 1) / kStepsAtOnce;
  std::vector<std::exception_ptr> failures(pieces);
  team_->ForEach(pieces, &cost_, [&](std::size_t piece, std::size_t worker) {
    const std::size_t first = piece * kStepsAtOnce;
    BodyEngine& engine = worker == 0 ? *engine_ : *further_engines_[worker - 1];
    try {
      TakeSteps(engine, all.subspan(first, std::min(kStepsAtOnce, all.size() - first)), who);
    } catch (...) {
      failures[piece] = std::current_exception();
    }
  });
  for (const std::exception_ptr& failure : failures) {
    if (failure != nullptr) std::rethrow_exception(failure);
  }
}

std::string BodyIslands::NameOf(int island, std::span<const double> diverged) const {
  const std::vector<int>& members = members_[static_cast<std::size_t>(island)];
  std::size_t place = 0;
  while (place + 1 < members.size() &&
         AllFinite(engine_->Read(island, static_cast<int>(place), diverged))) {
    ++place;
  }
  return fmt::format("body '{}'", names_[static_cast<std::size_t>(members[place])]);
}

void BodyIslands::Save(Saved* saved) const {
  saved->resize(islands_.size());
  for (std::size_t i = 0; i < islands_.size(); ++i) islands_[i].Save(&(*saved)[i]);
}

void BodyIslands::Restore(const Saved& saved) {
  for (std::size_t i = 0; i < islands_.size(); ++i) islands_[i].Restore(saved[i]);
}

}  // namespace tcs
