// System V shared memory, and the making of System V objects: all calls are the kernel's, but for
// the times that it keeps of the objects.
#include <sys/ipc.h>
#include <sys/msg.h>
#include <sys/sem.h>
#include <sys/shm.h>

#include <atomic>

#include "libtcs_preload/errno_result.h"
#include "libtcs_preload/guest.h"
#include "libtcs_preload/ipc_times.h"
#include "libtcs_preload/raw_syscall.h"

using namespace tcs::preload;
using tcs::shm::IpcEvent;
using tcs::shm::IpcKind;

namespace {

// Which object is attached where; shmdt does not say. Beyond so many attachments a time of
// detaching is not noted.
struct Attachment {
  std::atomic<const void*> at;
  std::atomic<int> id;
};
Attachment g_attachments[256];

void Remember(const void* at, int id) {
  for (Attachment& attachment : g_attachments) {
    const void* free = nullptr;
    if (!attachment.at.compare_exchange_strong(free, at)) continue;
    attachment.id.store(id);
    return;
  }
}

// The object's number, or -1.
int Forget(const void* at) {
  for (Attachment& attachment : g_attachments) {
    if (attachment.at.load() != at) continue;
    const int id = attachment.id.load();
    attachment.at.store(nullptr);
    return id;
  }
  return -1;
}

// An object that is new to tcs counts as made now.
int Made(IpcKind kind, long id) {
  GuestThread* t = Current();
  if (id >= 0 && t != nullptr && !IsNotedIpc(*t, kind, static_cast<int>(id))) {
    NoteIpc(*t, kind, static_cast<int>(id), IpcEvent::kChanged);
  }
  return static_cast<int>(ToErrno(id));
}

}  // namespace

TCS_EXPORT int msgget(key_t key, int flags) noexcept {
  return Made(IpcKind::kMessages, RawSyscall(SYS_msgget, key, flags));
}

TCS_EXPORT int semget(key_t key, int count, int flags) noexcept {
  return Made(IpcKind::kSemaphores, RawSyscall(SYS_semget, key, count, flags));
}

TCS_EXPORT int shmget(key_t key, std::size_t size, int flags) noexcept {
  return Made(IpcKind::kMemory, RawSyscall(SYS_shmget, key, static_cast<long>(size), flags));
}

TCS_EXPORT void* shmat(int id, const void* address, int flags) noexcept {
  const long at = RawSyscall(SYS_shmat, id, Arg(address), flags);
  if (at < 0 && at > -4096) return reinterpret_cast<void*>(ToErrno(at));
  if (GuestThread* t = Current(); t != nullptr) {
    NoteIpc(*t, IpcKind::kMemory, id, IpcEvent::kPut);
    Remember(reinterpret_cast<const void*>(at), id);
  }
  return reinterpret_cast<void*>(at);
}

TCS_EXPORT int shmdt(const void* address) noexcept {
  const long result = RawSyscall(SYS_shmdt, Arg(address));
  GuestThread* t = result == 0 ? Current() : nullptr;
  const int id = t != nullptr ? Forget(address) : -1;
  if (id >= 0) NoteIpc(*t, IpcKind::kMemory, id, IpcEvent::kTaken);
  return static_cast<int>(ToErrno(result));
}

TCS_EXPORT int shmctl(int id, int command, shmid_ds* status) noexcept {
  const long result = RawSyscall(SYS_shmctl, id, command, Arg(status));
  GuestThread* t = result >= 0 ? Current() : nullptr;
  if (t != nullptr) {
    if (command == IPC_SET) NoteIpc(*t, IpcKind::kMemory, id, IpcEvent::kChanged);
    if (command == IPC_STAT) ShowIpcTimes(*t, id, status);
    if (command == SHM_STAT || command == SHM_STAT_ANY) {
      ShowIpcTimes(*t, static_cast<int>(result), status);
    }
  }
  return static_cast<int>(ToErrno(result));
}
