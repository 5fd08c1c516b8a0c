// The times that System V objects tell of themselves (IPC_STAT), virtual. errno is kept.
#pragma once

#include <sys/msg.h>
#include <sys/sem.h>
#include <sys/shm.h>

#include "libtcs_preload/guest.h"
#include "shm/ipc_times.h"

namespace tcs::preload {

// Something has just happened to the object.
void NoteIpc(GuestThread& thread, shm::IpcKind kind, int id, shm::IpcEvent event);

// True once anything has been noted of the object.
bool IsNotedIpc(const GuestThread& thread, shm::IpcKind kind, int id);

void ForgetIpc(GuestThread& thread, shm::IpcKind kind, int id);

// Puts virtual times where the kernel has put some of its own. An operation that no program under
// tcs has done is shown as done now.
void ShowIpcTimes(GuestThread& thread, int id, msqid_ds* status);
void ShowIpcTimes(GuestThread& thread, int id, semid_ds* status);
void ShowIpcTimes(GuestThread& thread, int id, shmid_ds* status);

}  // namespace tcs::preload
