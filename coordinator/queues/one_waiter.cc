#include "coordinator/queues/one_waiter.h"

#include <algorithm>
#include <unordered_map>

namespace tcs {

namespace {

// In the order of waiting, or of waiters in an epoll set the other way round.
bool GoesBefore(const EventWaiter& one, const EventWaiter& other) {
  const auto turn = [](const EventWaiter& waiter) {
    const auto order = static_cast<std::int64_t>(waiter.order);
    return waiter.last_is_first ? -order : order;
  };
  return turn(one) < turn(other);
}

}  // namespace

std::vector<EventShare> ShareEvents(
    std::vector<EventWaiter> waiters,
    const std::function<bool(int first, int second)>& is_one_event) {
  std::stable_sort(waiters.begin(), waiters.end(), GoesBefore);
  std::unordered_map<std::uint64_t, std::vector<int>> takers;  // woken ones, at each place
  std::vector<EventShare> shares;
  for (const EventWaiter& waiter : waiters) {
    shares.push_back({waiter.thread, kNoThread});
    if (!waiter.takes) continue;
    std::vector<int>& woken = takers[waiter.place];
    const auto first = std::find_if(woken.begin(), woken.end(), [&](int thread) {
      return is_one_event(thread, waiter.thread);
    });
    if (first != woken.end()) {
      shares.back().passed_over_for = *first;
    } else {
      woken.push_back(waiter.thread);
    }
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
