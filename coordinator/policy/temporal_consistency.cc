#include "coordinator/policy/temporal_consistency.h"

#include <algorithm>
#include <utility>

#include "shm/check.h"

namespace tcs {

TemporalConsistency::Leaf TemporalConsistency::AddLeaf(int computer) {
  TCS_CHECK(leaves_.empty() || leaves_.back().computer <= computer);
  const auto leaf = static_cast<Leaf>(leaves_.size());
  leaves_.push_back({computer, {}, VirtualTime::Never(), VirtualTime::Never(), {}, {}});
  leaves_.back().rank = RankOf(leaf);
  order_.insert(leaves_.back().rank);
  return leaf;
}

TemporalConsistency::Rank TemporalConsistency::RankOf(Leaf leaf) const {
  return {At(leaf).next, HasGivenWay(leaf), leaf != acted_last_, leaf};
}

// One of the leaf's times, or the leaf that acted last, has changed.
void TemporalConsistency::Reorder(Leaf leaf) {
  Times& times = leaves_[static_cast<std::size_t>(leaf)];
  const Rank rank = RankOf(leaf);
  if (rank == times.rank) return;
  auto node = order_.extract(times.rank);
  node.value() = times.rank = rank;
  order_.insert(std::move(node));
}

void TemporalConsistency::FirstActs() {
  const Leaf last = acted_last_;
  acted_last_ = std::get<Leaf>(*order_.begin());
  leaves_[static_cast<std::size_t>(acted_last_)].gave_way.reset();
  Reorder(acted_last_);
  if (last >= 0) Reorder(last);
}

void TemporalConsistency::GiveWay(Leaf leaf) {
  Times& times = leaves_[static_cast<std::size_t>(leaf)];
  times.gave_way = times.next;
  Reorder(leaf);
}

bool TemporalConsistency::HasGivenWay(Leaf leaf) const {
  return At(leaf).gave_way == At(leaf).next;
}

void TemporalConsistency::Update(Leaf leaf, VirtualTime progress, VirtualTime next,
                                 VirtualTime quiet) {
  next = std::max(next, EarliestWake());
  Times& times = leaves_[static_cast<std::size_t>(leaf)];
  TCS_CHECK(progress >= times.progress);
  const bool progressed = times.progress != progress;
  const bool was_quiet = times.next > times.run;
  times.progress = progress;
  times.run = next;
  times.next = std::max(next, quiet);
  if (const bool is_quiet = times.next > times.run; is_quiet != was_quiet) {
    if (is_quiet) quiet_.push_back(leaf);
    if (was_quiet) std::erase(quiet_, leaf);
  }
  Reorder(leaf);
  if (progressed) NoteDrift(progress);
}

void TemporalConsistency::UpdateDynamics(VirtualTime progress, VirtualTime output) {
  has_dynamics_ = true;
  dynamics_ = progress;
  output_ = output;
  NoteDrift(progress);
}

void TemporalConsistency::NoteDrift(VirtualTime progress) {
  furthest_ = std::max(furthest_, progress);
  VirtualTime least = std::min(Least(), LeastRun(-1));
  if (has_dynamics_) least = std::min(least, dynamics_);
  if (least != VirtualTime::Never()) drift_ = std::max(drift_, progress - least);
}

VirtualTime TemporalConsistency::Least() const {
  return order_.empty() ? VirtualTime::Never() : std::get<0>(*order_.begin());
}

TemporalConsistency::Leaf TemporalConsistency::First() const {
  return Least() == VirtualTime::Never() ? -1 : std::get<Leaf>(*order_.begin());
}

std::size_t TemporalConsistency::Soonest(VirtualTime until, std::span<Leaf> leaves) const {
  std::size_t count = 0;
  for (const Rank& rank : order_) {
    if (count == leaves.size() || std::get<VirtualTime>(rank) >= until) break;
    leaves[count++] = std::get<Leaf>(rank);
  }
  return count;
}

VirtualTime TemporalConsistency::LeastOther(Leaf leaf) const {
  auto other = order_.begin();
  if (other != order_.end() && std::get<Leaf>(*other) == leaf) ++other;
  return other == order_.end() ? VirtualTime::Never() : std::get<0>(*other);
}

// Of the quiet leaves.
VirtualTime TemporalConsistency::LeastRun(Leaf but) const {
  VirtualTime least = VirtualTime::Never();
  for (const Leaf leaf : quiet_) {
    if (leaf != but) least = std::min(least, At(leaf).run);
  }
  return least;
}

VirtualTime TemporalConsistency::Horizon(Leaf leaf) const {
  const VirtualTime slowest = std::min(LeastOther(leaf), LeastRun(leaf));
  return std::min(end_, AtMostNever(slowest, drift_bound_));
}

VirtualTime TemporalConsistency::DynamicsHorizon() const {
  return has_dynamics_ ? AtMostNever(dynamics_, drift_bound_) : VirtualTime::Never();
}

VirtualTime TemporalConsistency::BeforeOutput(VirtualTime time) const {
  const bool has_output = has_dynamics_ && !output_.IsNever();
  return has_output ? std::min(time, output_ - VirtualNs(1)) : time;
}

VirtualTime TemporalConsistency::ReadSafe(Leaf leaf) const {
  return BeforeOutput(LeastOther(leaf));
}

VirtualTime TemporalConsistency::LocalReadSafe(Leaf leaf) const {
  VirtualTime safe = VirtualTime::Never();
  for (Leaf other = leaf - 1; other >= 0 && At(other).computer == At(leaf).computer; --other) {
    safe = std::min(safe, EarliestActOf(other, leaf));
  }
  const auto end = static_cast<Leaf>(leaves_.size());
  for (Leaf other = leaf + 1; other < end && At(other).computer == At(leaf).computer; ++other) {
    safe = std::min(safe, EarliestActOf(other, leaf));
  }
  return BeforeOutput(safe);
}

// While `but` does nothing.
VirtualTime TemporalConsistency::EarliestActOf(Leaf leaf, Leaf but) const {
  return std::max(At(leaf).progress, std::min(At(leaf).next, LeastOther(but)));
}

VirtualTime TemporalConsistency::NextInputFromOutside(Leaf leaf) const {
  for (const Rank& rank : order_) {
    if (At(std::get<Leaf>(rank)).computer != At(leaf).computer) return std::get<0>(rank);
  }
  return VirtualTime::Never();
}

VirtualTime TemporalConsistency::NextOutput() const {
  return has_dynamics_ ? output_ : VirtualTime::Never();
}

}  // namespace tcs
