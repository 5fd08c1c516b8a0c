#include "libtcs_preload/ipc_times.h"

#include "libtcs_preload/exchange.h"
#include "libtcs_preload/virtual_clock.h"

namespace tcs::preload {

namespace {

using shm::IpcEvent;
using shm::IpcKind;

// The thread's own note since its last dispatch, which is not in the table yet; null: there is
// none.
const shm::IpcNote* OwnNote(const GuestThread& thread, std::uint64_t object, IpcEvent event) {
  const shm::ThreadSlot& slot = *thread.slot;
  for (std::uint32_t i = slot.ipc_count.load(std::memory_order_relaxed); i > 0; --i) {
    const shm::IpcNote& note = slot.ipc_notes[i - 1];
    if (note.object != object) continue;
    if (note.event == event || note.event == IpcEvent::kRemoved) return &note;
  }
  return nullptr;
}

// The time by the table and the thread's own notes; 0: never.
std::int64_t TimeOf(const GuestThread& thread, std::uint64_t object, IpcEvent event) {
  if (const shm::IpcNote* note = OwnNote(thread, object, event); note != nullptr) {
    return note->event == event ? note->at_ns : 0;
  }
  const shm::IpcPlace* place = shm::FindIpcPlace(g_run->ipc_times, object);
  if (place == nullptr) return 0;
  return place->at_ns[static_cast<std::uint32_t>(event)].load(std::memory_order_relaxed);
}

std::int64_t RealtimeNs(GuestThread& thread) { return NowNs(thread) + OffsetNs(Clock::kRealtime); }

void Show(GuestThread& thread, IpcKind kind, int id, IpcEvent event, __time_t* seconds) {
  if (*seconds == 0) return;
  const std::int64_t at = TimeOf(thread, shm::IpcObject(kind, id), event);
  *seconds = (at != 0 ? at : RealtimeNs(thread)) / kNsPerSecond;
}

}  // namespace

// A note that a handler makes meanwhile may be overwritten.
void NoteIpc(GuestThread& thread, IpcKind kind, int id, IpcEvent event) {
  shm::ThreadSlot& slot = *thread.slot;
  const std::uint64_t object = shm::IpcObject(kind, id);
  const std::int64_t now = RealtimeNs(thread);
  std::uint32_t count = slot.ipc_count.load(std::memory_order_relaxed);
  if (count > 0 && count <= shm::kMostIpcNotes) {
    shm::IpcNote& last = slot.ipc_notes[count - 1];
    if (last.object == object && last.event == event) {
      last.at_ns = now;
      return;
    }
  }
  if (count >= shm::kMostIpcNotes) {  // the coordinator takes the notes over at any stop
    Exchange(thread, Request{.kind = shm::NotificationKind::kPassOn});
    count = 0;
  }
  slot.ipc_notes[count] = shm::IpcNote{object, now, event, 0};
  slot.ipc_count.store(count + 1, std::memory_order_relaxed);
}

bool IsNotedIpc(const GuestThread& thread, IpcKind kind, int id) {
  const std::uint64_t object = shm::IpcObject(kind, id);
  const shm::ThreadSlot& slot = *thread.slot;
  for (std::uint32_t i = slot.ipc_count.load(std::memory_order_relaxed); i > 0; --i) {
    const shm::IpcNote& note = slot.ipc_notes[i - 1];
    if (note.object == object) return note.event != IpcEvent::kRemoved;
  }
  return shm::FindIpcPlace(g_run->ipc_times, object) != nullptr;
}

void ForgetIpc(GuestThread& thread, IpcKind kind, int id) {
  NoteIpc(thread, kind, id, IpcEvent::kRemoved);
}

void ShowIpcTimes(GuestThread& thread, int id, msqid_ds* status) {
  Show(thread, IpcKind::kMessages, id, IpcEvent::kChanged, &status->msg_ctime);
  Show(thread, IpcKind::kMessages, id, IpcEvent::kPut, &status->msg_stime);
  Show(thread, IpcKind::kMessages, id, IpcEvent::kTaken, &status->msg_rtime);
}

void ShowIpcTimes(GuestThread& thread, int id, semid_ds* status) {
  Show(thread, IpcKind::kSemaphores, id, IpcEvent::kChanged, &status->sem_ctime);
  Show(thread, IpcKind::kSemaphores, id, IpcEvent::kPut, &status->sem_otime);
}

void ShowIpcTimes(GuestThread& thread, int id, shmid_ds* status) {
  Show(thread, IpcKind::kMemory, id, IpcEvent::kChanged, &status->shm_ctime);
  Show(thread, IpcKind::kMemory, id, IpcEvent::kPut, &status->shm_atime);
  Show(thread, IpcKind::kMemory, id, IpcEvent::kTaken, &status->shm_dtime);
}

}  // namespace tcs::preload
