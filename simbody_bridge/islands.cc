// Time of the whole passes at once; an island is integrated when somebody looks at one of its
// bodies. So only what changes for an island stops it: a command that differs from the one before,
// and an instant that is looked at.
//
// Save costs nothing but a note: an island is saved when it is about to change, for all checkpoints
// that were taken since it last did. So to restore one takes back what has changed, and no more.
#include "simbody_bridge/islands.h"

#include <algorithm>
#include <deque>
#include <utility>

#include "simbody_bridge/make_engine.h"
#include "simbody_bridge/require.h"
#include "simbody_bridge/world_check.h"

namespace tcs {
namespace {

// Commands whose effects nobody has looked at: an island with so many of them is brought forward to
// the time of one, where it would stop in any case.
constexpr std::size_t kMostPending = 64;

bool AreEqual(const Wrench& one, const Wrench& other) {
  return one.force_n == other.force_n && one.torque_nm == other.torque_nm;
}

// An island as it can be put back.
struct SavedIsland {
  std::unique_ptr<Dynamics::Checkpoint> state;
  std::vector<Wrench> last_wrenches;
  std::vector<VirtualTime> last_times;
  std::deque<VirtualTime> pending;
};

// Of each island, as it was; null: it has not changed since.
struct SavedWorld {
  VirtualTime now;
  std::vector<std::shared_ptr<const SavedIsland>> islands;
};

struct IslandsCheckpoint : Dynamics::Checkpoint {
  const void* origin = nullptr;
  std::shared_ptr<SavedWorld> world;
};

struct Island {
  std::unique_ptr<Dynamics> dynamics;
  // The latest command to each of its bodies.
  std::vector<Wrench> last_wrenches;
  std::vector<VirtualTime> last_times;
  std::deque<VirtualTime> pending;  // when commands act that it has not come to, in order
};

class Islands : public Dynamics {
 public:
  explicit Islands(const WorldSpec& world);

  VirtualTime Now() const override { return now_; }
  void AdvanceTo(VirtualTime t) override;
  void Apply(int body, const Wrench& wrench, VirtualTime t) override;
  BodyState Read(int body) const override;
  std::unique_ptr<Checkpoint> Save() override;
  void Restore(const Checkpoint& checkpoint) override;

 private:
  struct Place {
    std::size_t island;
    int body;  // in it
  };

  const Place& PlaceOf(int body) const;
  void Keep(std::size_t island) const;
  void BringTo(std::size_t island, VirtualTime t) const;

  std::vector<Place> places_;       // by body
  std::vector<std::string> names_;  // by body
  // Where they stand is a matter of who has looked, not of what they are.
  mutable std::vector<Island> islands_;
  mutable std::vector<std::weak_ptr<SavedWorld>> checkpoints_;  // that may still be restored
  VirtualTime now_;
};

Islands::Islands(const WorldSpec& world) : places_(world.bodies.size()) {
  for (const BodySpec& body : world.bodies) names_.push_back(body.name);
  for (const std::vector<int>& bodies : IslandsOf(world)) {
    WorldSpec part = world;
    part.bodies.clear();
    for (const int body : bodies) {
      const auto index = static_cast<std::size_t>(body);
      places_[index] = {islands_.size(), static_cast<int>(part.bodies.size())};
      part.bodies.push_back(world.bodies[index]);
    }
    Island island;
    island.dynamics = MakeEngine(part);
    island.last_wrenches.resize(bodies.size());
    island.last_times.resize(bodies.size());
    islands_.push_back(std::move(island));
  }
}

const Islands::Place& Islands::PlaceOf(int body) const {
  Require(body >= 0 && static_cast<std::size_t>(body) < places_.size(),
          "no such body in the dynamics");
  return places_[static_cast<std::size_t>(body)];
}

void Islands::AdvanceTo(VirtualTime t) {
  Require(t >= now_ && !t.IsNever(), "the dynamics can only advance to a later, finite time");
  now_ = t;
}

// The island is about to change.
void Islands::Keep(std::size_t index) const {
  std::shared_ptr<const SavedIsland> saved;
  std::erase_if(checkpoints_, [](const auto& checkpoint) { return checkpoint.expired(); });
  for (const std::weak_ptr<SavedWorld>& known : checkpoints_) {
    const std::shared_ptr<SavedWorld> checkpoint = known.lock();
    if (checkpoint->islands[index] != nullptr) continue;
    if (saved == nullptr) {
      Island& island = islands_[index];
      saved = std::make_shared<const SavedIsland>(SavedIsland{
          island.dynamics->Save(), island.last_wrenches, island.last_times, island.pending});
    }
    checkpoint->islands[index] = saved;
  }
}

void Islands::BringTo(std::size_t index, VirtualTime t) const {
  Island& island = islands_[index];
  if (island.dynamics->Now() >= t) return;
  Keep(index);
  island.dynamics->AdvanceTo(t);
  // What acts at that very instant is still to be applied.
  while (!island.pending.empty() && island.pending.front() < t) island.pending.pop_front();
}

void Islands::Apply(int body, const Wrench& wrench, VirtualTime t) {
  const Place place = PlaceOf(body);
  Require(t >= now_ && !t.IsNever(), "a command cannot act before the dynamics' present");
  CheckWrench(names_[static_cast<std::size_t>(body)], wrench);
  Island& island = islands_[place.island];
  const auto own = static_cast<std::size_t>(place.body);
  const bool is_latest = t >= island.last_times[own];
  // It changes nothing, so nothing need stop for it.
  if (is_latest && AreEqual(wrench, island.last_wrenches[own])) return;
  Keep(place.island);
  if (is_latest) {
    island.last_wrenches[own] = wrench;
    island.last_times[own] = t;
  }
  island.dynamics->Apply(place.body, wrench, t);
  island.pending.insert(std::upper_bound(island.pending.begin(), island.pending.end(), t), t);
  if (island.pending.size() < kMostPending) return;
  const VirtualTime reached = island.pending[kMostPending / 2];
  if (reached <= now_) BringTo(place.island, reached);
}

BodyState Islands::Read(int body) const {
  const Place place = PlaceOf(body);
  BringTo(place.island, now_);
  return islands_[place.island].dynamics->Read(place.body);
}

std::unique_ptr<Dynamics::Checkpoint> Islands::Save() {
  auto world = std::make_shared<SavedWorld>();
  world->now = now_;
  world->islands.resize(islands_.size());
  std::erase_if(checkpoints_, [](const auto& checkpoint) { return checkpoint.expired(); });
  checkpoints_.push_back(world);
  auto checkpoint = std::make_unique<IslandsCheckpoint>();
  checkpoint->origin = this;
  checkpoint->world = std::move(world);
  return checkpoint;
}

void Islands::Restore(const Checkpoint& checkpoint) {
  const auto* saved = dynamic_cast<const IslandsCheckpoint*>(&checkpoint);
  Require(saved && saved->origin == this, "a checkpoint belongs to the dynamics that saved it");
  for (std::size_t i = 0; i < islands_.size(); ++i) {
    const std::shared_ptr<const SavedIsland> before = saved->world->islands[i];
    if (before == nullptr) continue;
    Keep(i);  // for others
    Island& island = islands_[i];
    island.dynamics->Restore(*before->state);
    island.last_wrenches = before->last_wrenches;
    island.last_times = before->last_times;
    island.pending = before->pending;
  }
  now_ = saved->world->now;
}

}  // namespace

std::vector<std::vector<int>> IslandsOf(const WorldSpec& world) {
  std::vector<std::vector<int>> islands;
  for (std::size_t i = 0; i < world.bodies.size(); ++i) islands.push_back({static_cast<int>(i)});
  return islands;
}

std::unique_ptr<Dynamics> MakeDynamics(const WorldSpec& world) {
  CheckWorld(world);
  return std::make_unique<Islands>(world);
}

}  // namespace tcs
