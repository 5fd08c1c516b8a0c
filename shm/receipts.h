// Where one activation of a thread ends and the next begins although the thread did not wait in
// between: it received a message that was there already. Both sides of the segment use this rule.
//
// An activation begins when a wait ends. What the thread receives then belongs to that activation.
// If the thread works on it (sends something, or computes for kWorkNs) and then receives again,
// that begins its next activation, whether or not it had to wait. A program's start counts as such
// work, so its first message begins an activation, too. Pieces that are received one after the
// other, several of one message or all that wait in a socket, begin none.
//
// A sleep that needs no asking, because it ends inside the thread's horizon or was over when it
// began, is a wait like another one: it is written down here, too, in runs whose threads note
// that (RunHeader::notes_activity).
//
// The state is written by the thread, and by the coordinator while the thread is stopped. The
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
    std::int64_t time_ns;     // the thread's clock; as a sleep began
    std::int64_t cpu_ns;      // what it had been charged
    std::int64_t release_ns;  // when a sleep was to end; of others it is not known here
    Of of;
    std::uint32_t padding;
    WorkCounts work;  // of the thread until then, where it is counted
  };

  std::int64_t received_cpu_ns;  // what the thread had been charged at the last one
  std::uint32_t has_received;    // 1: in this activation
  std::uint32_t has_sent;        // 1: since then
  std::atomic<std::uint32_t> count;
  std::uint32_t allocations;  // since its last wait was over, where they are counted
  Entry entries[kMost];
};
static_assert(offsetof(Receipts, allocations) == 20);
static_assert(sizeof(Receipts) == 24 + 48 * Receipts::kMost);
static_assert(offsetof(Receipts, entries) == 24);

// Its wait is over.
inline void NoteWoken(Receipts& receipts) {
  receipts.has_received = receipts.has_sent = 0;
  receipts.allocations = 0;
}

inline void NoteStarted(Receipts& receipts) {
  receipts.has_received = receipts.has_sent = 1;
  receipts.allocations = 0;
}

inline void NoteSent(Receipts& receipts) { receipts.has_sent = 1; }

// True if this is where an activation begins. `cpu_ns`: what the thread has been charged.
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
