#include "libtcs_preload/call_file.h"

#include <errno.h>
#include <fcntl.h>

#include "libtcs_preload/raw_syscall.h"

namespace tcs::preload {

namespace {

// Moves the descriptor out of the way: a file that the call opens has the number that it would have
// without it.
int OutOfTheWay(int fd) {
  constexpr long kFar = 512;
  const long moved = RawSyscall(SYS_fcntl, fd, F_DUPFD_CLOEXEC, kFar);
  if (moved < 0) return fd;
  RawSyscall(SYS_close, fd);
  return static_cast<int>(moved);
}

long Ask(std::uint32_t what) { return RawSyscall(SYS_futex, 0, static_cast<long>(what)); }

}  // namespace

CallFile::~CallFile() {
  if (!is_kept_) return;
  // The process is the last one to close the file, because the close may take its time (SO_LINGER).
  LeaveFiles(thread_);
  PutBack();
}

void CallFile::PutBack() {
  if (taken_ >= 0) RawSyscall(SYS_close, taken_);
  taken_ = -1;
}

WaitResult CallFile::Take(WaitResult result, bool is_kept) {
  is_kept_ = is_kept && result != WaitResult::kInterrupted;
  if (!is_kept_) return result;
  const long taken = Ask(shm::kTakeFile);
  // A handler has waited for something else in between: the wait ends as if the handler had come
  // before what the call waits for.
  if (taken == -ENOENT) {
    is_kept_ = false;
    return WaitResult::kInterrupted;
  }
  taken_ = taken < 0 ? -1 : OutOfTheWay(static_cast<int>(taken));
  return result;
}

WaitResult CallFile::Wait(short events, std::int64_t deadline_ns, Waiting waiting) {
  PutBack();
  waiting.keep = is_kept_ ? shm::KeepFiles::kAgain : keep_;
  const pollfd waited{number_, events, 0};
  const WaitResult result = WaitForFds(thread_, &waited, 1, deadline_ns, waiting);
  return Take(result, thread_.keeps_files);
}

WaitResult CallFile::WaitForObject(shm::KernelObjectKind kind, std::int64_t deadline_ns,
                                   bool again) {
  PutBack();
  const Reply reply =
      Exchange(thread_, Request{.kind = shm::NotificationKind::kWaitObject,
                                .deadline_ns = deadline_ns,
                                .args = {static_cast<std::int64_t>(kind), 0, again ? 1 : 0,
                                         is_kept_ ? -1 : std::int64_t{number_} + 1},
                                .interruptible = true});
  return Take(ResultOf(reply.reason), reply.values[0] != 0);
}

void LeaveFiles(GuestThread& thread) {
  thread.keeps_files = false;
  Ask(shm::kLeaveFiles);
}

}  // namespace tcs::preload
