#include "libtcs_preload/ipc_times.h"

#include "libtcs_preload/virtual_clock.h"

namespace tcs::preload {

namespace {

using shm::IpcEvent;
using shm::IpcKind;

shm::IpcTimes& Times() { return *shm::IpcTimesOf(g_header); }

std::int64_t RealtimeNs(GuestThread& thread) { return NowNs(thread) + OffsetNs(Clock::kRealtime); }

void Show(GuestThread& thread, IpcKind kind, int id, IpcEvent event, __time_t* seconds) {
  if (*seconds == 0) return;
  const shm::IpcPlace* place = shm::FindIpcPlace(Times(), shm::IpcObject(kind, id));
  const std::int64_t at =
      place == nullptr
          ? 0
          : place->at_ns[static_cast<std::uint32_t>(event)].load(std::memory_order_relaxed);
  *seconds = (at != 0 ? at : RealtimeNs(thread)) / kNsPerSecond;
}

}  // namespace

void NoteIpc(GuestThread& thread, IpcKind kind, int id, IpcEvent event) {
  shm::IpcPlace* place = shm::TakeIpcPlace(Times(), shm::IpcObject(kind, id));
  if (place == nullptr) return;
  place->at_ns[static_cast<std::uint32_t>(event)].store(RealtimeNs(thread),
                                                        std::memory_order_relaxed);
}

bool IsNotedIpc(IpcKind kind, int id) {
  return shm::FindIpcPlace(Times(), shm::IpcObject(kind, id)) != nullptr;
}

void ForgetIpc(IpcKind kind, int id) {
  shm::IpcPlace* place = shm::FindIpcPlace(Times(), shm::IpcObject(kind, id));
  if (place != nullptr) place->object.store(shm::IpcTimes::kRemoved, std::memory_order_release);
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
