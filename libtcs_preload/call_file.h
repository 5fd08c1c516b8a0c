// The file that a call was made on. Linux keeps it for as long as the call lasts, whatever becomes
// of its number meanwhile: closed, replaced, or used again. So does the coordinator while a thread
// waits. Where the number has come to mean another file then, or none, the call goes on with a
// descriptor that the coordinator puts into the process for one attempt. That descriptor is never
// there while the thread waits, because a child would inherit it, and no end of file would come.
//
// On the stack of the call; async-signal-safe.
#pragma once

#include "libtcs_preload/exchange.h"
#include "libtcs_preload/fd_wait.h"
#include "libtcs_preload/guest.h"

namespace tcs::preload {

class CallFile {
 public:
  CallFile(GuestThread& thread, int number, shm::KeepFiles keep = shm::KeepFiles::kForCall)
      : thread_(thread), number_(number), keep_(keep) {}
  // The call is over.
  ~CallFile();
  CallFile(const CallFile&) = delete;
  CallFile& operator=(const CallFile&) = delete;

  GuestThread& thread() const { return thread_; }
  // The descriptor that the next system call is made on.
  int fd() const { return is_kept_ ? taken_ : number_; }

  // As WaitForFds. After a signal the call begins anew, with the file that its number means then.
  WaitResult Wait(short events, std::int64_t deadline_ns, Waiting waiting);
  // As Wait, for a kernel object that cannot be polled (KernelObjectKind).
  WaitResult WaitForObject(shm::KernelObjectKind kind, std::int64_t deadline_ns, bool again);

 private:
  void PutBack();
  WaitResult Take(WaitResult result, bool is_kept);

  GuestThread& thread_;
  const int number_;
  const shm::KeepFiles keep_;
  int taken_ = -1;        // where the file is in the process
  bool is_kept_ = false;  // by the coordinator: the number means something else
};

// The files that were kept for the thread are not needed any more.
void LeaveFiles(GuestThread& thread);

}  // namespace tcs::preload
