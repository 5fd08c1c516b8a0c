// One event, one waiter. Of several threads that wait to take from the same descriptor (read,
// accept, the events of an epoll set) the kernel wakes one: the one that waits longest, of those in
// one epoll set the one that came last. To the coordinator, which polls for each of them, the event
// comes for all. The others are passed over. What the first has left when it has tried is for the
// next of those that were passed over for it.
//
// Pure: threads are numbers; what is at a descriptor is asked of the caller.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

namespace tcs {

struct EventWaiter {
  int thread = -1;
  bool takes = false;          // else the event is for it in any case
  bool last_is_first = false;  // the last that came goes first
  std::uint64_t order = 0;     // of waiting
  std::uint64_t place = 0;     // events at different places are never one
};

inline constexpr int kNoThread = -1;

struct EventShare {
  int thread = kNoThread;
  int passed_over_for = kNoThread;  // none: it is woken
};

// An event has come for all of these: who is woken, in the order of waiting, and who is passed over
// for whom. `is_one_event`: whether the event of the second is the one that the first is woken for.
std::vector<EventShare> ShareEvents(std::vector<EventWaiter> waiters,
                                    const std::function<bool(int first, int second)>& is_one_event);

// The thread that these were passed over for has tried: the first of them for whom something is
// there is next, and those behind it are passed over for it now. All others are passed over for
// nobody any more.
struct Rest {
  int next = kNoThread;
  std::vector<int> behind;
};
Rest PassRestOn(std::vector<EventWaiter> passed_over,
                const std::function<bool(int thread)>& has_event);

}  // namespace tcs
