#include "coordinator/policy/temporal_consistency.h"

#include <algorithm>
#include <utility>

#include "shm/check.h"
#include "shm/time_values.h"

namespace tcs {

namespace {

constexpr std::int64_t kNoTimeNs = -1;

}  // namespace

TemporalConsistency::Leaf TemporalConsistency::AddLeaf(int computer) {
  TCS_CHECK(leaves_.empty() || leaves_.back().computer <= computer);
  const auto leaf = static_cast<Leaf>(leaves_.size());
  leaves_.push_back({computer, 0, shm::kNeverNs, shm::kNeverNs, kNoTimeNs, {}});
  leaves_.back().rank = RankOf(leaf);
  order_.insert(leaves_.back().rank);
  return leaf;
}

TemporalConsistency::Rank TemporalConsistency::RankOf(Leaf leaf) const {
  return {At(leaf).next_ns, HasGivenWay(leaf), leaf != acted_last_, leaf};
}

// One of its times, or who acted last, has changed.
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
  leaves_[static_cast<std::size_t>(acted_last_)].gave_way_ns = kNoTimeNs;
  Reorder(acted_last_);
  if (last >= 0) Reorder(last);
}

void TemporalConsistency::GiveWay(Leaf leaf) {
  Times& times = leaves_[static_cast<std::size_t>(leaf)];
  times.gave_way_ns = times.next_ns;
  Reorder(leaf);
}

bool TemporalConsistency::HasGivenWay(Leaf leaf) const {
  return At(leaf).gave_way_ns == At(leaf).next_ns;
}

void TemporalConsistency::Update(Leaf leaf, std::int64_t progress_ns, std::int64_t next_ns,
                                 std::int64_t quiet_ns) {
  next_ns = std::max(next_ns, EarliestWake());
  Times& times = leaves_[static_cast<std::size_t>(leaf)];
  TCS_CHECK(progress_ns >= times.progress_ns);
  const bool progressed = times.progress_ns != progress_ns;
  const bool was_quiet = times.next_ns > times.run_ns;
  times.progress_ns = progress_ns;
  times.run_ns = next_ns;
  times.next_ns = std::max(next_ns, quiet_ns);
  if (const bool is_quiet = times.next_ns > times.run_ns; is_quiet != was_quiet) {
    if (is_quiet) quiet_.push_back(leaf);
    if (was_quiet) std::erase(quiet_, leaf);
  }
  Reorder(leaf);
  if (progressed) NoteDrift(progress_ns);
}

void TemporalConsistency::UpdateDynamics(std::int64_t progress_ns, std::int64_t output_ns) {
  has_dynamics_ = true;
  dynamics_ns_ = progress_ns;
  output_ns_ = output_ns;
  NoteDrift(progress_ns);
}

void TemporalConsistency::NoteDrift(std::int64_t progress_ns) {
  furthest_ns_ = std::max(furthest_ns_, progress_ns);
  std::int64_t least = std::min(Least(), LeastRun(-1));
  if (has_dynamics_) least = std::min(least, dynamics_ns_);
  if (least != shm::kNeverNs) drift_ns_ = std::max(drift_ns_, progress_ns - least);
}

std::int64_t TemporalConsistency::Least() const {
  return order_.empty() ? shm::kNeverNs : std::get<0>(*order_.begin());
}

TemporalConsistency::Leaf TemporalConsistency::First() const {
  return Least() == shm::kNeverNs ? -1 : std::get<Leaf>(*order_.begin());
}

std::int64_t TemporalConsistency::LeastOther(Leaf leaf) const {
  auto other = order_.begin();
  if (other != order_.end() && std::get<Leaf>(*other) == leaf) ++other;
  return other == order_.end() ? shm::kNeverNs : std::get<0>(*other);
}

// Of the quiet ones.
std::int64_t TemporalConsistency::LeastRun(Leaf but) const {
  std::int64_t least = shm::kNeverNs;
  for (const Leaf leaf : quiet_) {
    if (leaf != but) least = std::min(least, At(leaf).run_ns);
  }
  return least;
}

std::int64_t TemporalConsistency::Horizon(Leaf leaf) const {
  const std::int64_t slowest_ns = std::min(LeastOther(leaf), LeastRun(leaf));
  return std::min(end_ns_, shm::AddSaturated(slowest_ns, drift_bound_ns_));
}

std::int64_t TemporalConsistency::DynamicsHorizon() const {
  return has_dynamics_ ? shm::AddSaturated(dynamics_ns_, drift_bound_ns_) : shm::kNeverNs;
}

std::int64_t TemporalConsistency::BeforeOutput(std::int64_t ns) const {
  return has_dynamics_ && output_ns_ != shm::kNeverNs ? std::min(ns, output_ns_ - 1) : ns;
}

std::int64_t TemporalConsistency::ReadSafe(Leaf leaf) const {
  return BeforeOutput(LeastOther(leaf));
}

std::int64_t TemporalConsistency::LocalReadSafe(Leaf leaf) const {
  std::int64_t safe = shm::kNeverNs;
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
std::int64_t TemporalConsistency::EarliestActOf(Leaf leaf, Leaf but) const {
  return std::max(At(leaf).progress_ns, std::min(At(leaf).next_ns, LeastOther(but)));
}

std::int64_t TemporalConsistency::NextInputFromOutside(Leaf leaf) const {
  for (const Rank& rank : order_) {
    if (At(std::get<Leaf>(rank)).computer != At(leaf).computer) return std::get<0>(rank);
  }
  return shm::kNeverNs;
}

std::int64_t TemporalConsistency::NextOutput() const {
  return has_dynamics_ ? output_ns_ : shm::kNeverNs;
}

}  // namespace tcs
