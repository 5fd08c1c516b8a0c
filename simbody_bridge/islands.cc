// Dynamics over islands: finds those that a call is about, and lets the engine take the steps that
// they need.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "simbody_bridge/dynamics.h"
#include "simbody_bridge/island.h"
#include "simbody_bridge/island_engine.h"
#include "simbody_bridge/require.h"
#include "simbody_bridge/world_check.h"

namespace tcs {
namespace {

// Commands to a body that nobody reads are worked off once there are so many.
constexpr std::size_t kMostPending = 64;

struct IslandsCheckpoint : Dynamics::Checkpoint {
  const void* origin = nullptr;
  VirtualTime now;
  std::vector<Island::Saved> islands;
};

class Islands : public Dynamics {
 public:
  explicit Islands(const WorldSpec& world)
      : members_(IslandsOf(world)),
        engine_(MakeEngine(world, members_)),
        places_(world.bodies.size()) {
    for (const BodySpec& body : world.bodies) names_.push_back(body.name);
    for (std::size_t i = 0; i < members_.size(); ++i) {
      const int bodies = static_cast<int>(members_[i].size());
      islands_.emplace_back(static_cast<int>(i), bodies, *engine_, work_);
      for (int place = 0; place < bodies; ++place) {
        places_[static_cast<std::size_t>(members_[i][static_cast<std::size_t>(place)])] = {i,
                                                                                           place};
      }
    }
  }

  int island_count() const override { return static_cast<int>(islands_.size()); }
  VirtualTime Now() const override { return now_; }
  void AdvanceTo(VirtualTime t) override;
  void Apply(int body, const Wrench& wrench, VirtualTime t) override;
  void Read(VirtualTime t, std::span<const int> bodies, std::span<BodyState> states) override;
  std::unique_ptr<Checkpoint> Save(std::unique_ptr<Checkpoint> reuse) override;
  void Restore(const Checkpoint& checkpoint) override;
  const Work& work() const override { return work_; }

 private:
  struct Place {
    std::size_t island;
    int place;
  };
  const Place& PlaceOf(int body) const;
  void Reach(VirtualTime t);
  void TakeSteps();
  void TakeEachStep();
  void Check(const IslandStep& step) const;

  const std::vector<std::vector<int>> members_;  // bodies of each island
  std::unique_ptr<IslandEngine> engine_;
  std::vector<std::string> names_;
  std::vector<Place> places_;  // of each body
  std::vector<Island> islands_;
  Work work_;
  VirtualTime now_;
  // Memory of Reach and Read.
  std::vector<std::size_t> moving_;  // islands that somebody asks for, each once or more
  std::vector<IslandStep*> steps_;
  std::vector<double> state_;
};

const Islands::Place& Islands::PlaceOf(int body) const {
  Require(body >= 0 && body < static_cast<int>(places_.size()), "no such body in the dynamics");
  return places_[static_cast<std::size_t>(body)];
}

void Islands::AdvanceTo(VirtualTime t) {
  Require(t >= now_ && !t.IsNever(), "the dynamics can only advance to a later, finite time");
  now_ = t;
}

void Islands::Apply(int body, const Wrench& wrench, VirtualTime t) {
  const Place place = PlaceOf(body);
  Require(t >= now_ && !t.IsNever(), "a command cannot act before the dynamics' present");
  CheckWrench(names_[static_cast<std::size_t>(body)], wrench);
  Island& island = islands_[place.island];
  if (island.CommandsUntil(now_) >= kMostPending) {
    moving_.assign(1, place.island);
    Reach(now_);
  }
  island.Settle(now_);
  island.Apply(place.place, wrench, t);
}

void Islands::Read(VirtualTime t, std::span<const int> bodies, std::span<BodyState> states) {
  Require(t >= now_ && !t.IsNever(), "a state of the past is not known any more");
  Require(bodies.size() == states.size(), "one state for each body that is read");
  moving_.clear();
  for (const int body : bodies) moving_.push_back(PlaceOf(body).island);
  Reach(t);
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const Place& place = PlaceOf(bodies[i]);
    islands_[place.island].StateAt(t, &state_);
    states[i] = engine_->Read(static_cast<int>(place.island), place.place, state_);
  }
}

// Takes all steps that lead to `t` of those in `moving_`: the next one of each, until no one needs
// any more.
void Islands::Reach(VirtualTime t) {
  std::sort(moving_.begin(), moving_.end());
  moving_.erase(std::unique(moving_.begin(), moving_.end()), moving_.end());
  for (const std::size_t island : moving_) islands_[island].Settle(now_);
  for (;;) {
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
    TakeSteps();
    for (const std::size_t island : moving_) {
      islands_[island].Took();
      islands_[island].Settle(now_);
    }
  }
}

void Islands::TakeSteps() {
  try {
    engine_->TakeAll(steps_);
    for (const IslandStep* step : steps_) Check(*step);
  } catch (const std::exception&) {
    TakeEachStep();
  }
}

// One of the steps cannot be taken: to say which, and whose it is.
void Islands::TakeEachStep() {
  for (IslandStep* step : steps_) {
    const double from_s = islands_[static_cast<std::size_t>(step->island)].StepStart().seconds();
    try {
      engine_->Take(*step);
    } catch (const DynamicsError&) {
      throw;
    } catch (const std::exception& e) {
      throw DynamicsError(
          fmt::format("the integration from {:.12g} s on failed: {}", from_s, e.what()));
    }
    Check(*step);
  }
}

// With steps of a set length engines take whatever comes out of one, and stumble over it only in
// the next.
void Islands::Check(const IslandStep& step) const {
  const auto is_finite = [](double value) { return std::isfinite(value); };
  const auto all_finite = [&](const std::vector<double>& values) {
    return std::all_of(values.begin(), values.end(), is_finite);
  };
  const auto island = static_cast<std::size_t>(step.island);
  const double from_s = islands_[island].StepStart().seconds();
  if (all_finite(step.to) && all_finite(step.to_rate)) {
    if (LengthOf(step) > VirtualDuration{}) return;
    throw DynamicsError(fmt::format(
        "the integration from {:.12g} s on failed: the integrator makes no progress", from_s));
  }
  std::size_t place = 0;
  while (place + 1 < members_[island].size() &&
         AllFinite(engine_->Read(step.island, static_cast<int>(place), step.to))) {
    ++place;
  }
  throw DynamicsError(fmt::format("body '{}': its motion has diverged by {:.12g} s",
                                  names_[static_cast<std::size_t>(members_[island][place])],
                                  from_s + step.length_s));
}

std::unique_ptr<Dynamics::Checkpoint> Islands::Save(std::unique_ptr<Checkpoint> reuse) {
  if (reuse == nullptr) reuse = std::make_unique<IslandsCheckpoint>();
  auto* checkpoint = dynamic_cast<IslandsCheckpoint*>(reuse.get());
  Require(checkpoint != nullptr && (checkpoint->origin == nullptr || checkpoint->origin == this),
          "a checkpoint belongs to the dynamics that saved it");
  checkpoint->origin = this;
  checkpoint->now = now_;
  checkpoint->islands.resize(islands_.size());
  for (std::size_t i = 0; i < islands_.size(); ++i) islands_[i].Save(&checkpoint->islands[i]);
  return reuse;
}

void Islands::Restore(const Checkpoint& checkpoint) {
  const auto* saved = dynamic_cast<const IslandsCheckpoint*>(&checkpoint);
  Require(saved != nullptr && saved->origin == this,
          "a checkpoint belongs to the dynamics that saved it");
  now_ = saved->now;
  for (std::size_t i = 0; i < islands_.size(); ++i) islands_[i].Restore(saved->islands[i]);
}

}  // namespace

std::vector<std::vector<int>> IslandsOf(const WorldSpec& world) {
  std::vector<std::vector<int>> islands = world.together;
  std::vector<bool> placed(world.bodies.size(), false);
  for (const std::vector<int>& island : islands) {
    for (const int body : island) {
      if (body < 0 || static_cast<std::size_t>(body) >= placed.size() ||
          placed[static_cast<std::size_t>(body)]) {
        throw DynamicsError(fmt::format(
            "together: {} is not the index of a body that is in no other island", body));
      }
      placed[static_cast<std::size_t>(body)] = true;
    }
  }
  std::erase_if(islands, [](const std::vector<int>& island) { return island.empty(); });
  for (std::size_t body = 0; body < placed.size(); ++body) {
    if (!placed[body]) islands.push_back({static_cast<int>(body)});
  }
  return islands;
}

std::unique_ptr<Dynamics> MakeDynamics(const WorldSpec& world) {
  CheckWorld(world);
  return std::make_unique<Islands>(world);
}

}  // namespace tcs
