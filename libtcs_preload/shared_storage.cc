// Threads that find another's thread-local storage as theirs.
//
// A thread that is made by the system call without CLONE_SETTLS has its maker's storage, and with
// it the maker's GuestThread: both threads would speak through one slot. Such a thread may not call
// most of the C library, natively, either; but it may make system calls by that library. The
// coordinator sees the thread made, and says so in the maker's clock page before the thread runs.
// From then on a thread that finds that page is told apart by its number.
#include <errno.h>

#include <atomic>

#include "libtcs_preload/guest.h"
#include "libtcs_preload/raw_syscall.h"

namespace tcs::preload {

namespace {

constexpr int kMostSharers = 64;  // threads that live at a time; others' calls are let through

constexpr std::int32_t kNobody = 0;

struct Sharer {
  std::atomic<std::int32_t> tid;  // whose `state` it is; negative: who is about to have it; kNobody
  GuestThread state;
};

Sharer g_sharers[kMostSharers];
GuestThread g_nobody{.attaching = true};  // attaches never

bool HasEnded(std::int32_t pid, std::int32_t tid) {
  return RawSyscall(SYS_tgkill, pid, tid, 0) == -ESRCH;
}

// Null: all places are taken.
GuestThread* Claim(std::int32_t pid, std::int32_t tid) {
  for (Sharer& sharer : g_sharers) {
    std::int32_t before = sharer.tid.load();
    const bool is_free = before == kNobody || (before > 0 && HasEnded(pid, before));
    if (!is_free || !sharer.tid.compare_exchange_strong(before, -tid)) continue;
    sharer.state = GuestThread{};
    sharer.tid = tid;
    return &sharer.state;
  }
  return nullptr;
}

}  // namespace

GuestThread& StateInSharedStorage() {
  const auto tid = static_cast<std::int32_t>(RawSyscall(SYS_gettid));
  if (tid == t_thread.tid) return t_thread;
  for (Sharer& sharer : g_sharers) {
    const std::int32_t whose = sharer.tid.load();
    if (whose == tid) return sharer.state;
    if (whose == -tid) return g_nobody;  // a handler has interrupted Claim
  }
  // A process that shares the memory has a slot in another place, which is not mapped here.
  const auto pid = static_cast<std::int32_t>(RawSyscall(SYS_getpid));
  GuestThread* const claimed = pid == t_thread.pid ? Claim(pid, tid) : nullptr;
  return claimed != nullptr ? *claimed : g_nobody;
}

void ForgetSharers() {
  for (Sharer& sharer : g_sharers) {
    if (sharer.tid.load() == kNobody) continue;
    sharer.state = GuestThread{};
    sharer.tid = kNobody;
  }
}

}  // namespace tcs::preload
