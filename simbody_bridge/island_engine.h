// The work of a physics engine for the islands of a world: steps, as functions of a state and of
// the acting wrenches. The engine keeps no time, knows no commands, and relies on nothing that it
// remembers from an earlier step: equal steps lead to equal states, bitwise, whatever was computed
// in between. So islands can be taken back, and integrated in any order.
//
// One thread at a time calls an engine of free bodies. Several threads may call an engine of
// models, each about an island of its own, but for StartOf, AddIsland and CopyModel.
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
  VirtualTime at;  // the step's beginning
  std::vector<double> from;
  std::vector<Wrench> wrenches;       // commanded, one for each place of the island
  std::vector<Remainder> remainders;  // likewise; none where no command lags
  VirtualDuration limit;              // the step is no longer than this, and more than 0
  double try_s = 0;                   // the length that the engine tries first, within the limit

  std::vector<double> to;                  // empty: steps are set, and Within says where
  double length_s = 0;                     // exactly limit.seconds() if it is as long as that
  double next_try_s = 0;                   // for the next step
  std::vector<double> from_rate, to_rate;  // derivatives, of an engine that interpolates
  std::vector<double> course;              // further data to interpolate by, if any
};

// The wrenches that act on an island at an instant: the commands, and what is left of the commands
// before.
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

  // Takes a step. Throws what the engine throws where it cannot; the next step may be taken then.
  virtual void Take(IslandStep& step) = 0;
  // The part that most likely keeps the island from going on, where the island's last step failed
  // or is all too short: "joint 'elbow'". Empty: not known.
  virtual std::string SuspectOf(int /*island*/) { return {}; }
  // Takes several steps, of different islands. Leads bitwise to where each step alone would.
  virtual void TakeAll(std::span<IslandStep* const> steps) {
    for (IslandStep* step : steps) Take(*step);
  }
  // The state `after` the beginning of a step that was taken, up to its end.
  virtual void Within(const IslandStep& step, VirtualDuration after,
                      std::vector<double>* state) = 0;
};

// An engine of free bodies: each place is a body.
class BodyEngine : public IslandEngine {
 public:
  // Whether two such engines may be called at the same time, and it does not matter for their speed
  // which of them takes an island's next step.
  virtual bool may_be_doubled() const { return false; }
  // The state of a body in a state of its island.
  virtual BodyState Read(int island, int place, std::span<const double> state) const = 0;
};

// The bodies of each island: the groups of world.together, and each other body alone. Throws
// DynamicsError where a body is named twice, or is none.
std::vector<std::vector<int>> IslandsOf(const WorldSpec& world);

// The engine that world.integrator names. `world` has passed CheckWorld. Throws DynamicsError if
// the engine refuses it all the same.
std::unique_ptr<BodyEngine> MakeEngine(const WorldSpec& world,
                                       const std::vector<std::vector<int>>& islands);

}  // namespace tcs
