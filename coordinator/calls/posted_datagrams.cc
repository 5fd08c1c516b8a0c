#include "coordinator/calls/posted_datagrams.h"

#include <cstdint>

#include "shm/check.h"
#include "shm/command_ring.h"

namespace tcs {

namespace {

constexpr const char* kWrongDatagrams = "posted datagrams that cannot be";

}  // namespace

const char* PostedDatagrams::Take(Task& task) {
  TCS_CHECK(run_.turn.IsOf(task));
  shm::CommandRing& ring = SlotOf(task).command_ring;
  const std::uint64_t end = ring.posted.load(std::memory_order_acquire);
  if (end == task.posts_taken) return nullptr;
  // Nothing in the world moves any more.
  const bool is_over = !world_.present() || run_.IsInGrace();
  while (task.posts_taken != end) {
    shm::CommandRing::Head head;
    if (!shm::ReadHead(ring, task.posts_taken, end, &head) || head.receiver >= world_.receivers()) {
      return kWrongDatagrams;
    }
    datagram_.resize(head.size);
    shm::CopyFromRing(ring, task.posts_taken + sizeof head, datagram_.data(), head.size);
    task.posts_taken += shm::RoomFor(head.size);
    if (is_over) continue;
    world_.ReceivePosted(head.receiver, datagram_,
                         {run_.WrittenAt(OwnTime(head.time_ns)),
                          {static_cast<std::uint64_t>(task.tid), head.ran_ns}});
  }
  ring.taken.store(end, std::memory_order_release);
  return nullptr;
}

}  // namespace tcs
