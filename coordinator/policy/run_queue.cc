#include "coordinator/policy/run_queue.h"

#include <algorithm>
#include <numeric>
#include <optional>

namespace tcs {

std::vector<RunQueue::Ready>::const_iterator RunQueue::Find(Thread thread) const {
  return std::find_if(ready_.begin(), ready_.end(),
                      [thread](const Ready& ready) { return ready.thread == thread; });
}

bool RunQueue::IsReady(Thread thread) const { return Find(thread) != ready_.end(); }

std::size_t RunQueue::CountOf(Priority priority) const {
  const auto begin = std::partition_point(
      ready_.begin(), ready_.end(), [&](const Ready& ready) { return ready.priority > priority; });
  const auto end = std::partition_point(
      begin, ready_.end(), [&](const Ready& ready) { return ready.priority == priority; });
  return static_cast<std::size_t>(end - begin);
}

bool RunQueue::Precedes(const Ready& one, const Ready& other) {
  return one.priority > other.priority ||
         (one.priority == other.priority && one.first && !other.first);
}

void RunQueue::Add(const Ready& added) {
  if (const auto found = Find(added.thread); found != ready_.end()) {
    Ready& known = ready_[static_cast<std::size_t>(found - ready_.begin())];
    known.from = added.from;
    known.allowed = added.allowed;
    return;
  }
  const auto behind = std::find_if(ready_.begin(), ready_.end(),
                                   [&](const Ready& ready) { return Precedes(added, ready); });
  ready_.insert(behind, added);
}

void RunQueue::Remove(Thread thread) {
  if (const auto found = Find(thread); found != ready_.end()) ready_.erase(found);
  std::replace(on_.begin(), on_.end(), thread, kNobody);
}

void RunQueue::Rotate(Thread thread) {
  const auto found = Find(thread);
  if (found != ready_.end()) SetPriority(thread, found->priority);
}

void RunQueue::SetPriority(Thread thread, Priority priority) {
  const auto found = Find(thread);
  if (found == ready_.end()) return;
  Ready moved = *found;
  moved.priority = priority;
  moved.first = false;
  ready_.erase(found);
  Add(moved);
}

void RunQueue::SetAllowed(Thread thread, std::uint64_t allowed) {
  if (const auto found = Find(thread); found != ready_.end()) {
    ready_[static_cast<std::size_t>(found - ready_.begin())].allowed = allowed;
  }
}

bool RunQueue::HasTurn(Thread thread) const {
  return std::any_of(turns_.begin(), turns_.end(),
                     [thread](const Turn& turn) { return turn.thread == thread; });
}

bool RunQueue::StaysElsewhere(Thread thread, std::size_t core) const {
  const auto found = std::find(on_.begin(), on_.end(), thread);
  if (found == on_.end()) return false;
  const auto home = static_cast<std::size_t>(found - on_.begin());
  return home != core && turns_[home].thread == kNobody;
}

void RunQueue::Choose(std::size_t core, VirtualTime progress, bool keep_places) {
  Turn& turn = turns_[core];
  for (const Ready& ready : ready_) {
    if ((ready.allowed >> (core & 63) & 1) == 0 || HasTurn(ready.thread)) continue;
    if (keep_places && StaysElsewhere(ready.thread, core)) continue;
    const VirtualTime start = std::max(progress, ready.from);
    if (start < turn.start) turn = Turn{ready.thread, start};
    if (start == progress) return;  // no thread can start earlier
  }
}

void RunQueue::Assign(const std::vector<VirtualTime>& progress) {
  std::fill(turns_.begin(), turns_.end(), Turn{});
  if (turns_.size() == 1) return Choose(0, progress[0], false);
  std::vector<std::size_t> cores(turns_.size());
  std::iota(cores.begin(), cores.end(), std::size_t{0});
  std::stable_sort(cores.begin(), cores.end(),
                   [&](std::size_t a, std::size_t b) { return progress[a] < progress[b]; });
  for (const bool keep_places : {true, false}) {
    for (const std::size_t core : cores) {
      if (turns_[core].thread == kNobody) Choose(core, progress[core], keep_places);
    }
  }
  Displace(progress);
}

// A thread that stays where it was may have lost that core to a more urgent thread that runs
// nowhere else, while a less urgent thread was given another core.
void RunQueue::Displace(const std::vector<VirtualTime>& progress) {
  // The most urgent thread first: a thread that is displaced comes later, and may displace others.
  for (const Ready& ready : ready_) {
    if (HasTurn(ready.thread)) continue;
    std::optional<std::size_t> least;
    auto least_urgent = ready_.end();
    for (std::size_t core = 0; core < turns_.size(); ++core) {
      if ((ready.allowed >> (core & 63) & 1) == 0) continue;
      const auto owner = Find(turns_[core].thread);
      const bool gives_way = owner != ready_.end() && Precedes(ready, *owner) &&
                             std::max(progress[core], ready.from) <= turns_[core].start;
      if (!gives_way || (least.has_value() && !Precedes(*least_urgent, *owner))) continue;
      least = core;
      least_urgent = ready_.begin() + (owner - ready_.begin());
    }
    if (least.has_value()) turns_[*least] = {ready.thread, std::max(progress[*least], ready.from)};
  }
}

bool RunQueue::HasWaitingEqual(std::size_t core) const {
  return IsWantedByEqual(core, turns_[core].thread);
}

bool RunQueue::IsWantedByEqual(std::size_t core, Thread thread) const {
  const auto own = Find(thread);
  if (own == ready_.end()) return false;
  return std::any_of(ready_.begin(), ready_.end(), [&](const Ready& ready) {
    const bool has_core = turns_[core].thread == ready.thread;
    return ready.thread != thread && ready.priority == own->priority &&
           (ready.allowed >> (core & 63) & 1) != 0 && (has_core || !HasTurn(ready.thread));
  });
}

bool RunQueue::YieldsTo(std::size_t core, Priority priority, bool first) const {
  const auto own = Find(turns_[core].thread);
  return own == ready_.end() ||
         Precedes({.thread = kNobody, .priority = priority, .from = {}, .first = first}, *own);
}

VirtualTime RunQueue::NextToPrecede(std::size_t core) const {
  VirtualTime next = VirtualTime::Never();
  const auto own = Find(turns_[core].thread);
  if (own == ready_.end()) return next;
  for (const Ready& ready : ready_) {
    if (!Precedes(ready, *own)) break;  // nor does any thread behind it
    if (HasTurn(ready.thread)) continue;
    if ((ready.allowed >> (core & 63) & 1) != 0) next = std::min(next, ready.from);
  }
  return next;
}

}  // namespace tcs
