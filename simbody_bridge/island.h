// One island in time: the steps that it has taken and the commands to its bodies.
//
// The steps are the engine's natural ones. A change (an instant whose commands leave other wrenches
// acting than before it) ends the step that covers it: the island goes on from the state within
// that step at that instant. Whether the change was known when the step was taken does not matter:
// a step that went past it is cut where the change is, and the part of the step after it is
// forgotten. So the island's motion is a function of its changes alone, and to take something back
// costs nothing but the steps that have to be taken anew.
//
// States are computed when they are needed: for an engine with steps of a set length, states are
// all there is to compute, and a change that comes before a step's end spares the state at that
// end.
#pragma once

#include <cstddef>
#include <vector>

#include "simbody_bridge/island_engine.h"

namespace tcs {

// The steps between two looks at whether an integration is to be interrupted.
inline constexpr int kStepsBetweenLooks = 64;

// The length of a step that was taken, in whole nanoseconds; 0 if the step led nowhere.
VirtualDuration LengthOf(const IslandStep& step);

// Longer than any step.
inline constexpr VirtualDuration kAnyLength = VirtualDuration::Seconds(1'000'000);

class Island {
 public:
  // A Saved is all that the island goes on from. The vectors of a default Saved grow at the first
  // use, and not again.
  struct Command {
    VirtualTime at;
    int place;
    Wrench wrench;
  };
  // The beginning of a step, and what acted until then.
  struct Node {
    VirtualTime at;
    std::vector<double> state;
    std::vector<Wrench> wrenches;
    std::vector<Remainder> remainders;
    double try_s = 0;
    VirtualTime changed_at;  // the last change before
  };
  struct Saved {
    Node origin;
    std::vector<Command> commands;
  };

  // The engine and `work` outlive this.
  Island(int index, int bodies, IslandEngine& engine, Dynamics::Work& work);
  // An island that goes on from `start`, with these commands, none of which is for an earlier time.
  Island(int index, Node start, std::vector<Command> commands, IslandEngine& engine,
         Dynamics::Work& work);

  // A command for `t`, not before the time that was settled last.
  void Apply(int place, const Wrench& wrench, VirtualTime t);
  // Neither a command for a time before `t` comes any more nor is a state before it asked for.
  void Settle(VirtualTime t);

  // The step to take on the way to the state at `t`; none: the state is known. The step is valid
  // until the next call, and no longer than `most` unless steps are set. Once the step has been
  // taken, call Took.
  IslandStep* NextStepTo(VirtualTime t, VirtualDuration most = kAnyLength);
  void Took();
  // The time at which the next step begins, and the island's state then.
  VirtualTime known_until() const { return frontier_.at; }
  const std::vector<double>& StateAtFrontier();

  // The state at `t`, a time since the one settled last, up to which no step is left to take.
  void StateAt(VirtualTime t, std::vector<double>* state);
  // The wrenches that acted until `t`.
  Acting ActingUntil(VirtualTime t) const;
  // The step that leads to the state at `t`, which is after its beginning; null at the island's own
  // beginning. `t` as of StateAt. The step is valid until the next call that is not const.
  const IslandStep* StepTo(VirtualTime t) const;

  // The node that an island would go on from that began at `t`; `t` as of StateAt.
  Node NodeAt(VirtualTime t);
  // All commands from the earliest time on that can still be asked for.
  const std::vector<Command>& commands() const { return commands_; }

  // How many commands have taken effect by `t` and not been worked off.
  std::size_t CommandsUntil(VirtualTime t) const;

  void Save(Saved* saved) const;
  void Restore(const Saved& saved);

 private:
  struct Leg {
    Node start;
    IslandStep step;
    VirtualTime to;          // the step's end, in whole nanoseconds
    VirtualTime changed_at;  // the last change up to its start
    // The state within the step that was asked for last, and when that is.
    VirtualTime within_at = VirtualTime::Never();
    std::vector<double> within;
  };

  const Node& Origin() const { return used_ > 0 ? legs_.front().start : frontier_; }
  const Wrench& ActingAfter(VirtualTime t, int place) const;
  void TakeBackTo(VirtualTime t);
  void Depart(const Node& start, VirtualDuration most, Leg* leg);
  void LetLag(const Node& start, IslandStep* step) const;
  void LimitAfterChange(const Node& start, IslandStep* step) const;
  VirtualTime ChangeWithin(const Leg& leg) const;
  void FindFrontier();
  void GoTo(const Leg& leg, VirtualTime t, Node* node) const;
  const std::vector<double>& StateOf(Leg& leg, VirtualTime t);

  const int index_;
  IslandEngine& engine_;
  Dynamics::Work& work_;
  // Commands in the order in which they take effect, from the first leg's start on.
  std::vector<Command> commands_;
  std::vector<Leg> legs_;  // the first `used_` count; the others are memory to use
  std::size_t used_ = 0;
  Node frontier_;               // where the next leg begins; Origin() where there is no leg
  bool knows_frontier_ = true;  // all of frontier_, where the last leg leads; else its time
};

}  // namespace tcs
