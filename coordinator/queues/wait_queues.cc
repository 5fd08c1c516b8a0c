#include "coordinator/queues/wait_queues.h"

#include <algorithm>
#include <utility>

#include "shm/check.h"

namespace tcs {

void WaitQueues::Wait(Thread thread, const KernelObject& object, bool is_back) {
  const auto [found, is_new] = places_.try_emplace(thread);
  Place& place = found->second;
  TCS_CHECK(!place.waits);
  if (is_new || !is_back || place.object != object) place.order = ++last_order_;
  place.object = object;
  place.waits = true;
}

void WaitQueues::Leave(Thread thread) {
  if (const auto found = places_.find(thread); found != places_.end()) found->second.waits = false;
}

std::vector<WaitQueues::Thread> WaitQueues::WaitersFor(const KernelObject& object) const {
  std::vector<std::pair<std::uint64_t, Thread>> waiters;
  for (const auto& [thread, place] : places_) {
    if (place.waits && place.object == object) waiters.emplace_back(place.order, thread);
  }
  std::sort(waiters.begin(), waiters.end());
  std::vector<Thread> threads;
  threads.reserve(waiters.size());
  for (const auto& [order, thread] : waiters) threads.push_back(thread);
  return threads;
}

std::vector<KernelObject> WaitQueues::AwaitedObjects() const {
  std::vector<KernelObject> objects;
  for (const auto& [thread, place] : places_) {
    const bool is_known = std::find(objects.begin(), objects.end(), place.object) != objects.end();
    if (place.waits && !is_known) objects.push_back(place.object);
  }
  return objects;
}

}  // namespace tcs
