// The root of the scheduler tree: keeps the progress of all leaves together, and says what is safe.
//
// The leaves are the virtual CPUs, numbered in the order they were added, and the dynamics. The
// least advanced one acts; how far it may go, and what it may read and write on the way, follows
// from when the others can act next. Conservative, as in parallel discrete-event simulation: GVT is
// Least(). Pure: makes no system call, reads no clock.
#pragma once

#include <cstddef>
#include <optional>
#include <set>
#include <span>
#include <tuple>
#include <vector>

#include "shm/time_kinds.h"

namespace tcs {

class TemporalConsistency {
 public:
  using Leaf = int;

  TemporalConsistency(VirtualDuration drift_bound, VirtualTime end)
      : drift_bound_(drift_bound), end_(end) {}

  // Of the computer with that number, whose leaves follow each other. What they do to each other is
  // inside.
  Leaf AddLeaf(int computer);

  // The leaf has come to `progress` and can neither act nor cause anything before `next`:
  // its progress if it has something to run, later if it idles, never if only others can wake it.
  // A time that others have left behind further than the drift bound becomes the earliest possible
  // one.
  // Before `quiet` it does nothing, although it has something to run: others need not wait for
  // it, but get no further away from it either.
  void Update(Leaf leaf, VirtualTime progress, VirtualTime next, VirtualTime quiet = {});
  // The same for the dynamics, which can always be advanced; nothing leaves them before
  // `output`.
  void UpdateDynamics(VirtualTime progress, VirtualTime output);

  // Another end of the run than the one before; and the dynamics go no further, nor are waited for.
  void EndAt(VirtualTime end) { end_ = end; }
  void EndDynamics() { has_dynamics_ = false; }

  // The least time at which any virtual CPU can act, and who can act then; -1: none can. Of several
  // it is the one that has acted last: who wakes a thread of another one gets on with what it does,
  // and has most often released the lock that the woken one wants before that one asks for it.
  VirtualTime Least() const;
  Leaf First() const;
  // The first of those that can act before `until`, in that order; at most as many as there is room
  // for. Returns how many there are.
  std::size_t Soonest(VirtualTime until, std::span<Leaf> leaves) const;
  // The first one is about to act.
  void FirstActs();
  // The leaf lets those act first that can act at the same time, until it can act at another one.
  void GiveWay(Leaf leaf);
  bool HasGivenWay(Leaf leaf) const;

  // How far the leaf may run: the drift bound beyond the slowest other virtual CPU, and the run's
  // end; and beyond the dynamics.
  VirtualTime Horizon(Leaf leaf) const;
  VirtualTime DynamicsHorizon() const;
  // Nothing that the leaf could read is produced before this any more. What the dynamics send at an
  // instant is there for a read at that instant.
  VirtualTime ReadSafe(Leaf leaf) const;
  // The same of what only leaves of its computer, and the dynamics, can produce. One of them that
  // waits can be woken as soon as any other one acts.
  VirtualTime LocalReadSafe(Leaf leaf) const;
  // When another leaf could next wake a thread of this one; a leaf of another computer.
  VirtualTime NextInput(Leaf leaf) const { return LeastOther(leaf); }
  VirtualTime NextInputFromOutside(Leaf leaf) const;
  // When the dynamics wake threads next.
  VirtualTime NextOutput() const;
  // No other leaf can read what is from before this any more.
  VirtualTime WriteSafe(Leaf leaf) const { return LeastOther(leaf); }

  // The largest difference of progress between two leaves so far.
  VirtualDuration drift() const { return drift_; }
  // No leaf can be woken at an earlier time any more: others have come further than the drift bound
  // beyond it.
  VirtualTime EarliestWake() const { return furthest_ - drift_bound_; }

 private:
  // Who acts before whom: by time, then those that have not given way, then who acted last, then by
  // number.
  using Rank = std::tuple<VirtualTime, bool, bool, Leaf>;
  struct Times {
    int computer;
    VirtualTime progress, next;
    VirtualTime run;  // it has something to run then, though it acts only at `next`
    std::optional<VirtualTime> gave_way;  // it gives way to others that can act then
    Rank rank;                            // as it stands among the others
  };
  const Times& At(Leaf leaf) const { return leaves_[static_cast<std::size_t>(leaf)]; }
  Rank RankOf(Leaf leaf) const;
  void Reorder(Leaf leaf);
  VirtualTime LeastOther(Leaf leaf) const;
  VirtualTime BeforeOutput(VirtualTime time) const;
  VirtualTime EarliestActOf(Leaf leaf, Leaf but) const;
  VirtualTime LeastRun(Leaf but) const;
  void NoteDrift(VirtualTime progress);

  VirtualDuration drift_bound_;
  VirtualTime end_;
  std::vector<Times> leaves_;
  bool has_dynamics_ = false;
  VirtualTime dynamics_, output_;
  std::set<Rank> order_;     // of all leaves, the one that can act soonest first
  std::vector<Leaf> quiet_;  // those that act later than they have something to run
  Leaf acted_last_ = -1;
  VirtualDuration drift_;
  VirtualTime furthest_;
};

}  // namespace tcs
