// The islands of free bodies: each body by itself, but for those that are declared to be together.
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

// Commands that nobody reads the effect of are worked off once an island has so many.
inline constexpr std::size_t kMostPending = 64;

class BodyIslands {
 public:
  // `work` outlives this.
  BodyIslands(const WorldSpec& world, Dynamics::Work& work);

  // Those whom steps are shared out to; outlives this.
  void UseTeam(const WorldSpec& world, Team& team);
  void InterruptBy(const std::function<bool()>& asked) { is_interrupted_ = asked; }

  int count() const { return static_cast<int>(islands_.size()); }
  // As of Dynamics. Nothing before `now` matters any more.
  void Apply(int body, const Wrench& wrench, VirtualTime t, VirtualTime now);
  void Read(VirtualTime t, VirtualTime now, std::span<const int> bodies,
            std::span<BodyState> states);

  using Saved = std::vector<Island::Saved>;
  void Save(Saved* saved) const;
  void Restore(const Saved& saved);

 private:
  struct Place {
    std::size_t island;
    int place;  // among its bodies
  };
  const Place& PlaceOf(int body) const;
  void Reach(VirtualTime t, VirtualTime now);
  void TakeAll();
  // Of the first body of the island that is not where numbers are.
  std::string NameOf(int island, std::span<const double> diverged) const;

  const std::vector<std::vector<int>> members_;  // bodies of each island
  std::unique_ptr<BodyEngine> engine_;           // none where there is no body
  std::function<bool()> is_interrupted_;         // see Dynamics::InterruptBy
  Team* team_ = nullptr;                         // where it has an engine for each:
  std::vector<std::unique_ptr<BodyEngine>> further_engines_;
  PieceCost cost_;
  std::vector<std::string> names_;
  std::vector<Place> places_;
  std::vector<Island> islands_;
  // Memory of Reach and Read.
  std::vector<std::size_t> moving_;  // islands that somebody asks for, each once or more
  std::vector<IslandStep*> steps_;   // of each of them
  std::vector<double> state_;
};

}  // namespace tcs
