#include "coordinator/policy/fixed_priority.h"

#include <algorithm>

namespace tcs {

std::vector<FixedPriority::Entry>::const_iterator FixedPriority::Find(Thread thread) const {
  return std::find_if(ready_.begin(), ready_.end(),
                      [thread](const Entry& entry) { return entry.thread == thread; });
}

void FixedPriority::Add(Thread thread, int priority) {
  if (IsReady(thread)) return;
  const auto behind = std::find_if(ready_.begin(), ready_.end(), [priority](const Entry& entry) {
    return entry.priority < priority;
  });
  ready_.insert(behind, Entry{thread, priority});
}

void FixedPriority::Remove(Thread thread) {
  if (const auto found = Find(thread); found != ready_.end()) ready_.erase(found);
}

void FixedPriority::Rotate(Thread thread) {
  const auto found = Find(thread);
  if (found != ready_.end()) SetPriority(thread, found->priority);
}

void FixedPriority::SetPriority(Thread thread, int priority) {
  if (!IsReady(thread)) return;
  Remove(thread);
  Add(thread, priority);
}

std::optional<FixedPriority::Thread> FixedPriority::First() const {
  if (ready_.empty()) return std::nullopt;
  return ready_.front().thread;
}

bool FixedPriority::IsReady(Thread thread) const { return Find(thread) != ready_.end(); }

bool FixedPriority::HasEqual(Thread thread) const {
  const auto found = Find(thread);
  if (found == ready_.end()) return false;
  return std::any_of(ready_.begin(), ready_.end(), [&](const Entry& entry) {
    return entry.thread != thread && entry.priority == found->priority;
  });
}

}  // namespace tcs
