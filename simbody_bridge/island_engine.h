// What a physics engine does for the islands of a world: steps, as functions of a state and of what
// acts. The engine keeps no time, knows no commands, and relies on nothing that it remembers from
// an earlier step: equal steps lead to equal states, bitwise, whatever was computed in between.
// That is what islands can be taken back by, and integrated in any order.
//
// One thread at a time calls an engine of free bodies. Of an engine of models several may, each
// about an island of its own, but for StartOf, AddIsland and CopyModel.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "simbody_bridge/dynamics.h"
#include "simbody_bridge/lag.h"

namespace tcs {

// A step of one island, before and after it is taken. States are coordinates and speeds in the
// engine's own order. The engine resizes what it writes; vectors are used again.
struct IslandStep {
  int island = 0;
  VirtualTime at;  // its beginning
  std::vector<double> from;
  std::vector<Wrench> wrenches;       // commanded, one for each place of the island
  std::vector<Remainder> remainders;  // likewise; none where no command lags
  VirtualDuration limit;              // the step is no longer than this, and more than 0
  double try_s = 0;                   // the length that the engine tries first, within the limit

  std::vector<double> to;                  // empty: it has set steps, and Within says where
  double length_s = 0;                     // exactly limit.seconds() if it is as long as that
  double next_try_s = 0;                   // for the next step
  std::vector<double> from_rate, to_rate;  // derivatives, of an engine that interpolates
  std::vector<double> course;              // what it interpolates by beside these, if anything
};

// What acts on an island at an instant: the commands, and what is left of those before.
struct Acting {
  const std::vector<Wrench>& wrenches;
  const std::vector<Remainder>& remainders;
  VirtualTime at;
};

// Where an island starts.
struct IslandStart {
  std::vector<double> state;
  double try_s = 0;
};

class IslandEngine {
 public:
  virtual ~IslandEngine() = default;

  virtual IslandStart StartOf(int island) = 0;
  // The `limit` of a step that nothing else limits.
  virtual VirtualDuration LongestStep(int island) const = 0;
  // Steps are as long as their limit, always: nothing else may limit them.
  virtual bool has_set_steps() const = 0;

  // Takes a step. Throws what the engine throws where it cannot; the next one may be taken then.
  virtual void Take(IslandStep& step) = 0;
  // What most likely keeps the island from going on, where the last step of it failed or is all too
  // short: "joint 'elbow'". Empty: nobody knows.
  virtual std::string SuspectOf(int /*island*/) { return {}; }
  // Several, of different islands. Leads bitwise to where each of them alone would.
  virtual void TakeAll(std::span<IslandStep* const> steps) {
    for (IslandStep* step : steps) Take(*step);
  }
  // The state `after` the beginning of a step that was taken, up to its end.
  virtual void Within(const IslandStep& step, VirtualDuration after,
                      std::vector<double>* state) = 0;
};

// Of free bodies: each place is a body.
class BodyEngine : public IslandEngine {
 public:
  // Whether two such engines may be called at the same time, and it does not matter for their speed
  // which of them takes an island's next step.
  virtual bool may_be_doubled() const { return false; }
  // How a body is in a state of its island.
  virtual BodyState Read(int island, int place, std::span<const double> state) const = 0;
};

// Which bodies each island has: those of world.together, and the others alone. Throws DynamicsError
// where a body is named twice, or is none.
std::vector<std::vector<int>> IslandsOf(const WorldSpec& world);

// The engine that world.integrator names. `world` has passed CheckWorld. Throws DynamicsError if
// the engine refuses it all the same.
std::unique_ptr<BodyEngine> MakeEngine(const WorldSpec& world,
                                       const std::vector<std::vector<int>>& islands);

}  // namespace tcs
