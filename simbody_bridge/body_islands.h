// The islands of free bodies: each body is one by itself, but for bodies that are declared to be
// together.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "simbody_bridge/island.h"
#include "simbody_bridge/team.h"

namespace tcs {

// Commands whose effect is not read are worked off once an island has so many.
inline constexpr std::size_t kMostPending = 64;

class BodyIslands {
 public:
  // `work` outlives this.
  BodyIslands(const WorldSpec& world, Dynamics::Work& work);

  // Steps are shared out to `team`, which outlives this.
  void UseTeam(const WorldSpec& world, Team& team);
  void InterruptBy(const std::function<bool()>& asked) { is_interrupted_ = asked; }

  int count() const { return static_cast<int>(islands_.size()); }
  // As Dynamics' functions. Nothing before `now` matters any more.
  void Apply(int body, const Wrench& wrench, VirtualTime t, VirtualTime now);
  void Read(VirtualTime t, VirtualTime now, std::span<const int> bodies,
            std::span<BodyState> states);

  using Saved = std::vector<Island::Saved>;
  void Save(Saved* saved) const;
  void Restore(const Saved& saved);

 private:
  struct Place {
    std::size_t island;
    int place;  // among the island's bodies
  };
  const Place& PlaceOf(int body) const;
  void Reach(VirtualTime t, VirtualTime now);
  void TakeAll();
  // The name of the first body of the island whose state in `diverged` is not finite.
  std::string NameOf(int island, std::span<const double> diverged) const;

  const std::vector<std::vector<int>> members_;  // bodies of each island
  std::unique_ptr<BodyEngine> engine_;           // none where there is no body
  std::function<bool()> is_interrupted_;         // see Dynamics::InterruptBy
  Team* team_ = nullptr;                         // null unless each worker has an engine:
  std::vector<std::unique_ptr<BodyEngine>> further_engines_;
  PieceCost cost_;
  std::vector<std::string> names_;
  std::vector<Place> places_;
  std::vector<Island> islands_;
  // Memory of Reach and Read.
  std::vector<std::size_t> moving_;  // islands that are asked for, each once or more
  std::vector<IslandStep*> steps_;   // one of each of these islands
  std::vector<double> state_;
};

}  // namespace tcs
