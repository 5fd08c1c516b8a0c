#include "libtcs_preload/receipts.h"

#include <sys/stat.h>

#include "libtcs_preload/exchange.h"
#include "libtcs_preload/raw_syscall.h"
#include "libtcs_preload/timer_fds.h"
#include "shm/clock_page.h"

namespace tcs::preload {

void NoteReceived(GuestThread& thread, shm::Receipts::Of of) {
  shm::Receipts& receipts = thread.slot->receipts;
  const shm::ClockPage& page = thread.slot->clock;
  const shm::ClockReading now = shm::ReadClock(page);
  if (!shm::NoteReceived(receipts, now.cpu_ns)) return;
  // A handler that comes between overwrites one, which is then not counted.
  const std::uint32_t count = receipts.count.load(std::memory_order_relaxed);
  if (count >= shm::Receipts::kMost) return;
  receipts.entries[count] = {shm::ShownTime(page, now), now.cpu_ns, of, 0, thread.slot->work};
  receipts.count.store(count + 1, std::memory_order_release);
  // Full: any stop empties it.
  if (count + 1 == shm::Receipts::kMost && thread.depth == 0) {
    Exchange(thread, Request{.kind = shm::NotificationKind::kPassOn});
  }
}

void NoteReceivedFrom(GuestThread& thread, int fd) {
  if (IsTimerFd(fd)) return NoteReceived(thread, shm::Receipts::Of::kTimer);
  struct stat status;
  if (RawSyscall(SYS_fstat, fd, Arg(&status)) == 0 && (status.st_mode & S_IFMT) == 0) return;
  NoteReceived(thread);
}

}  // namespace tcs::preload
