// One event, one waiter. Of several threads that wait to take from the same descriptor (read,
// accept, the events of an epoll set) the kernel wakes one: the one that has waited longest, or in
// one epoll set the one that came last. The coordinator polls for each of them, so it sees the
// event for all; it passes the others over. When the first thread has tried, what it has left is
// for the next thread that was passed over for it.
//
// Pure: threads are numbers; the caller is asked what is at a descriptor.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

namespace tcs {

struct EventWaiter {
  int thread = -1;
  bool takes = false;          // else the event is for the thread in any case
  bool last_is_first = false;  // the waiter that came last goes first
  std::uint64_t order = 0;     // of waiting
  std::uint64_t place = 0;     // events at different places are never one
};

inline constexpr int kNoThread = -1;

struct EventShare {
  int thread = kNoThread;
  int passed_over_for = kNoThread;  // none: the thread is woken
};

// An event has come for all of these threads: which are woken, in the order of waiting, and which
// are passed over for which. `is_one_event`: whether the event of the second is the one that the
// first is woken for.
std::vector<EventShare> ShareEvents(std::vector<EventWaiter> waiters,
                                    const std::function<bool(int first, int second)>& is_one_event);

// The thread for which these were passed over has tried. The first of them that finds something is
// next, and the ones behind it are now passed over for it. The other threads are not passed over
// any more.
struct Rest {
  int next = kNoThread;
  std::vector<int> behind;
};
Rest PassRestOn(std::vector<EventWaiter> passed_over,
                const std::function<bool(int thread)>& has_event);

}  // namespace tcs
