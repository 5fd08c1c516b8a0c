#include "coordinator/calls/ipc_notes.h"

#include <algorithm>
#include <atomic>

#include "coordinator/tasks/run_state.h"
#include "shm/ipc_times.h"

namespace tcs {

namespace {

using shm::IpcEvent;

constexpr const char* kWrongTimes = "times of System V objects";

bool IsObject(std::uint64_t object) {
  const auto kind = static_cast<shm::IpcKind>(object >> 32);
  return kind == shm::IpcKind::kMessages || kind == shm::IpcKind::kSemaphores ||
         kind == shm::IpcKind::kMemory;
}

}  // namespace

const char* TakeIpcNotes(Task& task, shm::RunMemory& memory, bool date_was_set) {
  shm::ThreadSlot& slot = SlotOf(task);
  const std::uint32_t count = slot.ipc_count.load();
  if (count == 0) return nullptr;
  slot.ipc_count.store(0);
  if (count > shm::kMostIpcNotes) return kWrongTimes;
  const std::int64_t origin_ns = memory.header.realtime_offset_ns;
  const std::int64_t now_ns = origin_ns + OwnNow(task).ns();
  for (std::uint32_t i = 0; i < count; ++i) {
    const shm::IpcNote note = slot.ipc_notes[i];
    std::atomic_signal_fence(std::memory_order_seq_cst);  // a checked value is not read again
    if (!IsObject(note.object) || note.event > IpcEvent::kRemoved) return kWrongTimes;
    const bool is_possible =
        note.at_ns >= origin_ns && note.at_ns - origin_ns <= task.grant.most_shown_ns;
    if (!is_possible && !date_was_set) return kWrongTimes;  // else the note may be of another date
    shm::IpcPlace* place = shm::TakeIpcPlace(memory.ipc_times, note.object);
    if (place == nullptr) continue;
    if (note.event == IpcEvent::kRemoved) {
      place->object.store(shm::IpcTimes::kRemoved);
      continue;
    }
    std::atomic<std::int64_t>& at = place->at_ns[static_cast<std::uint32_t>(note.event)];
    at.store(std::max(at.load(), std::min(note.at_ns, now_ns)));
  }
  return nullptr;
}

}  // namespace tcs
