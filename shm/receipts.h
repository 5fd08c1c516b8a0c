// Where one activation of a thread ends and the next begins although the thread did not wait in
// between: the thread received a message that was there already. The coordinator and the shim use
// the same rule.
//
// An activation begins when a wait ends. A message that the thread receives then belongs to that
// activation. If the thread works on it (sends something, or computes for kWorkNs) and then
// receives again, the second receipt begins its next activation, whether or not it had to wait. A
// program's start counts as such work, so its first message begins an activation, too. Pieces that
// are received one after the other, several of one message or all that wait in a socket, begin
// none.
//
// A sleep that needs no asking, because it ends inside the thread's horizon or was over when it
// began, is a wait like another one: such a sleep is written down here, too, in runs whose threads
// note
// that (RunHeader::notes_activity).
//
// The thread writes the state, and the coordinator does while the thread is stopped. The
// coordinator empties the list at each stop, and trusts nothing in it.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>

#include "shm/work_counts.h"

namespace tcs::shm {

struct Receipts {
  static constexpr std::int64_t kWorkNs = 1'000'000;  // charged
  static constexpr std::uint32_t kMost = 8;

  enum class Of : std::uint32_t { kMessage = 0, kTimer = 1, kSleep = 2 };

  // A receipt at which an activation began.
  struct Entry {
    std::int64_t time_ns;     // the thread's clock; for a sleep, at its begin
    std::int64_t cpu_ns;      // the thread's charge
    std::int64_t release_ns;  // when a sleep was to end; of other receipts it is not known here
    Of of;
    std::uint32_t padding;
    WorkCounts work;  // of the thread until then, where it is counted
  };

  std::int64_t received_cpu_ns;  // the thread's charge at its last receipt
  std::uint32_t has_received;    // 1: the thread has received in this activation
  std::uint32_t has_sent;        // 1: the thread has sent since its last receipt
  std::atomic<std::uint32_t> count;
  std::uint32_t allocations;  // since the thread's last wait was over, where they are counted
  Entry entries[kMost];
};
static_assert(offsetof(Receipts, allocations) == 20);
static_assert(sizeof(Receipts) == 24 + 48 * Receipts::kMost);
static_assert(offsetof(Receipts, entries) == 24);

// The thread's wait is over.
inline void NoteWoken(Receipts& receipts) {
  receipts.has_received = receipts.has_sent = 0;
  receipts.allocations = 0;
}

inline void NoteStarted(Receipts& receipts) {
  receipts.has_received = receipts.has_sent = 1;
  receipts.allocations = 0;
}

inline void NoteSent(Receipts& receipts) { receipts.has_sent = 1; }

// True if an activation begins with this receipt. `cpu_ns`: the thread's charge so far.
inline bool NoteReceived(Receipts& receipts, std::int64_t cpu_ns) {
  const bool worked =
      receipts.has_sent != 0 || cpu_ns - receipts.received_cpu_ns >= Receipts::kWorkNs;
  const bool begins = receipts.has_received != 0 && worked;
  receipts.has_received = 1;
  receipts.has_sent = 0;
  receipts.received_cpu_ns = cpu_ns;
  return begins;
}

}  // namespace tcs::shm
