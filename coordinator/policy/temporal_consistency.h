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

  // Adds a leaf of the computer with that number. The leaves of one computer follow each other, and
  // what they do to each other is not from outside.
  Leaf AddLeaf(int computer);

  // The leaf has come to `progress` and can neither act nor cause anything before `next`. `next` is
  // the leaf's progress if it has something to run, later if it idles, never if only others can
  // wake it. A time that other leaves have left behind further than the drift bound becomes the
  // earliest possible one.
  // Before `quiet` the leaf does nothing, although it has something to run: other leaves need not
  // wait for it, but get no further away from it either.
  void Update(Leaf leaf, VirtualTime progress, VirtualTime next, VirtualTime quiet = {});
  // The same for the dynamics, which can always be advanced; nothing leaves them before
  // `output`.
  void UpdateDynamics(VirtualTime progress, VirtualTime output);

  // EndAt: the run has another end than before. EndDynamics: the dynamics go no further, and are
  // not waited for.
  void EndAt(VirtualTime end) { end_ = end; }
  void EndDynamics() { has_dynamics_ = false; }

  // The least time at which any virtual CPU can act, and the leaf that can act then; -1: none can.
  // Of several it is the leaf that has acted last: a leaf that wakes a thread of another leaf gets
  // on with what it does, and has most often released the lock that the woken thread wants before
  // that thread asks for it.
  VirtualTime Least() const;
  Leaf First() const;
  // The first of the leaves that can act before `until`, in that order; at most as many as there is
  // room for. Returns how many there are.
  std::size_t Soonest(VirtualTime until, std::span<Leaf> leaves) const;
  // The first leaf is about to act.
  void FirstActs();
  // The leaf lets other leaves act first that can act at the same time, until it can act at another
  // time.
  void GiveWay(Leaf leaf);
  bool HasGivenWay(Leaf leaf) const;

  // How far the leaf may run: the drift bound beyond the slowest other virtual CPU, and the run's
  // end; and beyond the dynamics.
  VirtualTime Horizon(Leaf leaf) const;
  VirtualTime DynamicsHorizon() const;
  // Nothing that the leaf could read is produced before this any more. Data that the dynamics send
  // at an instant is there for a read at that instant.
  VirtualTime ReadSafe(Leaf leaf) const;
  // The same for data that only leaves of its computer, and the dynamics, can produce. A leaf of
  // the computer that waits can be woken as soon as any other leaf acts.
  VirtualTime LocalReadSafe(Leaf leaf) const;
  // When another leaf could next wake a thread of this leaf. FromOutside: when a leaf of another
  // computer could.
  VirtualTime NextInput(Leaf leaf) const { return LeastOther(leaf); }
  VirtualTime NextInputFromOutside(Leaf leaf) const;
  // When the dynamics wake threads next.
  VirtualTime NextOutput() const;
  // No other leaf can read data from before this any more.
  VirtualTime WriteSafe(Leaf leaf) const { return LeastOther(leaf); }

  // The largest difference of progress between two leaves so far.
  VirtualDuration drift() const { return drift_; }
  // No leaf can be woken at an earlier time any more: other leaves have come further than the drift
  // bound beyond that time.
  VirtualTime EarliestWake() const { return furthest_ - drift_bound_; }

 private:
  // The order in which leaves act: by time, then leaves that have not given way, then the leaf that
  // acted last, then by number.
  using Rank = std::tuple<VirtualTime, bool, bool, Leaf>;
  struct Times {
    int computer;
    VirtualTime progress, next;
    VirtualTime run;  // the leaf has something to run then, though it acts only at `next`
    std::optional<VirtualTime> gave_way;  // the leaf gives way to others that can act then
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
  std::vector<Leaf> quiet_;  // leaves that act later than they have something to run
  Leaf acted_last_ = -1;
  VirtualDuration drift_;
  VirtualTime furthest_;
};

}  // namespace tcs
