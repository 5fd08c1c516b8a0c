// What threads have done to System V objects, for everybody to see (shm/ipc_times.h).
#include <algorithm>

#include "coordinator/core/engine.h"

namespace tcs {

namespace {

using shm::IpcEvent;

bool IsObject(std::uint64_t object) {
  const auto kind = static_cast<shm::IpcKind>(object >> 32);
  return kind == shm::IpcKind::kMessages || kind == shm::IpcKind::kSemaphores ||
         kind == shm::IpcKind::kMemory;
}

}  // namespace

// False if the thread cannot have done what it has noted.
bool Engine::TakeIpcNotes(Task& task) {
  shm::ThreadSlot& slot = Slot(task);
  const std::uint32_t count = slot.ipc_count.load();
  if (count == 0) return true;
  slot.ipc_count.store(0);
  if (count > shm::kMostIpcNotes) return false;
  const std::int64_t origin_ns = header_->realtime_offset_ns;
  const std::int64_t now_ns = origin_ns + OwnNow(task).ns();
  for (std::uint32_t i = 0; i < count; ++i) {
    const shm::IpcNote note = slot.ipc_notes[i];
    std::atomic_signal_fence(std::memory_order_seq_cst);  // what is checked is not read again
    if (!IsObject(note.object) || note.event > IpcEvent::kRemoved || note.at_ns < origin_ns ||
        note.at_ns - origin_ns > task.grant.most_shown_ns) {
      return false;
    }
    shm::IpcPlace* place = shm::TakeIpcPlace(memory_->ipc_times, note.object);
    if (place == nullptr) continue;
    if (note.event == IpcEvent::kRemoved) {
      place->object.store(shm::IpcTimes::kRemoved);
      continue;
    }
    std::atomic<std::int64_t>& at = place->at_ns[static_cast<std::uint32_t>(note.event)];
    at.store(std::max(at.load(), std::min(note.at_ns, now_ns)));
  }
  return true;
}

}  // namespace tcs
