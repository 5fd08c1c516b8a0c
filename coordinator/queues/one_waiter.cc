#include "coordinator/queues/one_waiter.h"

#include <algorithm>

namespace tcs {

namespace {

// In the order of waiting, or of waiters in an epoll set the other way round.
bool GoesBefore(const EventWaiter& one, const EventWaiter& other) {
  const auto place = [](const EventWaiter& waiter) {
    const auto order = static_cast<std::int64_t>(waiter.order);
    return waiter.last_is_first ? -order : order;
  };
  return place(one) < place(other);
}

}  // namespace

std::vector<EventShare> ShareEvents(
    std::vector<EventWaiter> waiters,
    const std::function<bool(int first, int second)>& is_one_event) {
  std::stable_sort(waiters.begin(), waiters.end(), GoesBefore);
  std::vector<EventWaiter> woken;
  std::vector<EventShare> shares;
  for (const EventWaiter& waiter : waiters) {
    const auto first = std::find_if(woken.begin(), woken.end(), [&](const EventWaiter& one) {
      return waiter.takes && one.takes && is_one_event(one.thread, waiter.thread);
    });
    const bool wakes = first == woken.end();
    shares.push_back({waiter.thread, wakes ? kNoThread : first->thread});
    if (wakes) woken.push_back(waiter);
  }
  return shares;
}

Rest PassRestOn(std::vector<EventWaiter> passed_over,
                const std::function<bool(int thread)>& has_event) {
  std::stable_sort(passed_over.begin(), passed_over.end(), GoesBefore);
  Rest rest;
  for (const EventWaiter& waiter : passed_over) {
    if (rest.next != kNoThread) {
      rest.behind.push_back(waiter.thread);
    } else if (has_event(waiter.thread)) {
      rest.next = waiter.thread;
    }
  }
  return rest;
}

}  // namespace tcs
