#include "libtcs_preload/receipts.h"

#include "libtcs_preload/exchange.h"
#include "libtcs_preload/raw_syscall.h"
#include "libtcs_preload/timer_fds.h"
#include "shm/clock_page.h"

namespace tcs::preload {

namespace {

void Add(GuestThread& thread, const shm::Receipts::Entry& entry) {
  shm::Receipts& receipts = thread.slot->receipts;
  // A handler that comes between overwrites an entry, which is then not counted.
  const std::uint32_t count = receipts.count.load(std::memory_order_relaxed);
  if (count >= shm::Receipts::kMost) return;
  receipts.entries[count] = entry;
  receipts.count.store(count + 1, std::memory_order_release);
  // The list is full: any stop empties it.
  if (count + 1 == shm::Receipts::kMost && thread.depth == 0) {
    Exchange(thread, Request{.kind = shm::NotificationKind::kPassOn});
  }
}

}  // namespace

void NoteReceived(GuestThread& thread, shm::Receipts::Of of) {
  const shm::ClockPage& page = thread.slot->clock;
  const shm::ClockReading now = shm::ReadClock(page);
  if (!shm::NoteReceived(thread.slot->receipts, now.cpu_ns)) return;
  const std::int64_t at_ns = shm::ShownTime(page, now);
  Add(thread, {at_ns, now.cpu_ns, at_ns, of, 0, thread.slot->work});
}

void NoteSlept(GuestThread& thread, std::int64_t from_ns, std::int64_t cpu_ns,
               std::int64_t until_ns) {
  if (until_ns == from_ns) return;
  thread.slot->receipts.allocations = 0;
  if (g_header->notes_activity == 0) return;
  shm::NoteWoken(thread.slot->receipts);
  Add(thread, {from_ns, cpu_ns, until_ns, shm::Receipts::Of::kSleep, 0, thread.slot->work});
}

void NoteReceivedFrom(GuestThread& thread, int fd, bool has_name) {
  if (has_name) {
    NoteReceived(thread);
  } else if (IsTimerFd(fd)) {
    NoteReceived(thread, shm::Receipts::Of::kTimer);
  }
}

}  // namespace tcs::preload
