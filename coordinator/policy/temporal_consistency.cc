#include "coordinator/policy/temporal_consistency.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include "shm/check.h"
#include "shm/time_values.h"

namespace tcs {

namespace {

constexpr std::int64_t kNoTimeNs = -1;

}  // namespace

TemporalConsistency::Leaf TemporalConsistency::AddLeaf(int computer) {
  leaves_.push_back({computer, 0, shm::kNeverNs, kNoTimeNs});
  FindLeast();
  return static_cast<Leaf>(leaves_.size() - 1);
}

bool TemporalConsistency::ActsBefore(Leaf one, Leaf other) const {
  const auto rank = [this](Leaf leaf) {
    return std::tuple(At(leaf).next_ns, HasGivenWay(leaf), leaf != acted_last_, leaf);
  };
  return rank(one) < rank(other);
}

void TemporalConsistency::FindLeast() {
  first_ = second_ = -1;
  for (Leaf leaf = 0; leaf < static_cast<Leaf>(leaves_.size()); ++leaf) {
    if (first_ < 0 || ActsBefore(leaf, first_)) {
      second_ = std::exchange(first_, leaf);
    } else if (second_ < 0 || ActsBefore(leaf, second_)) {
      second_ = leaf;
    }
  }
}

void TemporalConsistency::FirstActs() {
  acted_last_ = first_;
  leaves_[static_cast<std::size_t>(first_)].gave_way_ns = kNoTimeNs;
}

void TemporalConsistency::GiveWay(Leaf leaf) {
  Times& times = leaves_[static_cast<std::size_t>(leaf)];
  times.gave_way_ns = times.next_ns;
  FindLeast();
}

bool TemporalConsistency::HasGivenWay(Leaf leaf) const {
  return At(leaf).gave_way_ns == At(leaf).next_ns;
}

void TemporalConsistency::Update(Leaf leaf, std::int64_t progress_ns, std::int64_t next_ns) {
  next_ns = std::max(next_ns, EarliestWake());
  Times& times = leaves_[static_cast<std::size_t>(leaf)];
  TCS_CHECK(progress_ns >= times.progress_ns);
  const bool moved = times.next_ns != next_ns;
  const bool progressed = times.progress_ns != progress_ns;
  times.progress_ns = progress_ns;
  times.next_ns = next_ns;
  if (moved) FindLeast();
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
  std::int64_t least = Least();
  if (has_dynamics_) least = std::min(least, dynamics_ns_);
  if (least != shm::kNeverNs) drift_ns_ = std::max(drift_ns_, progress_ns - least);
}

std::int64_t TemporalConsistency::Least() const {
  return first_ < 0 ? shm::kNeverNs : At(first_).next_ns;
}

TemporalConsistency::Leaf TemporalConsistency::First() const {
  return Least() == shm::kNeverNs ? -1 : first_;
}

std::int64_t TemporalConsistency::LeastOther(Leaf leaf) const {
  const Leaf other = leaf == first_ ? second_ : first_;
  return other < 0 ? shm::kNeverNs : At(other).next_ns;
}

std::int64_t TemporalConsistency::Horizon(Leaf leaf) const {
  return std::min(end_ns_, shm::AddSaturated(LeastOther(leaf), drift_bound_ns_));
}

std::int64_t TemporalConsistency::DynamicsHorizon() const {
  return has_dynamics_ ? shm::AddSaturated(dynamics_ns_, drift_bound_ns_) : shm::kNeverNs;
}

std::int64_t TemporalConsistency::ReadSafe(Leaf leaf) const {
  std::int64_t safe = LeastOther(leaf);
  if (has_dynamics_ && output_ns_ != shm::kNeverNs) safe = std::min(safe, output_ns_ - 1);
  return safe;
}

std::int64_t TemporalConsistency::NextInputFromOutside(Leaf leaf) const {
  std::int64_t next = shm::kNeverNs;
  for (const Times& times : leaves_) {
    if (times.computer != At(leaf).computer) next = std::min(next, times.next_ns);
  }
  return next;
}

std::int64_t TemporalConsistency::NextOutput() const {
  return has_dynamics_ ? output_ns_ : shm::kNeverNs;
}

}  // namespace tcs
