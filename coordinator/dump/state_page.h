// The memory that a coordinator and `tcsim dump` share. The coordinator notes there what it does,
// and leaves its whole state there when it is asked for it.
//
// The memory is a memfd without a name that the coordinator makes. A process that may look into the
// coordinator's /proc finds it there: a process of the same user, or of root. The process asks like
// this:
//
//   the asker                                   the coordinator
//   locks the memory (flock): one asks at a time
//   `asked` + 1, a byte into the pipe `wake_fd`
//                                               wakes, empties the pipe
//                                               writes `text` and `text_size`, then `answered`
//   waits until `answered` is its `asked`
//   copies the text, unlocks
//
// The coordinator reads nothing from here but `asked`, and trusts it no further than to repeat it.
// The comment above a field says who writes it. Times are the host's TSC where not said otherwise.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <type_traits>

namespace tcs {

// The coordinator's activity just now.
enum class Doing : std::uint32_t {
  kPrepares,      // the run has not begun; the coordinator may wait for a processor
  kSchedules,     // chooses who acts next, or answers what a thread has asked for
  kIntegrates,    // the dynamics
  kAwaitsThread,  // sleeps until the dispatched thread stops
  kAwaitsEvents,  // sleeps until the kernel tells of something, or for a while
  kWrites,        // tables and progress
  kEnds,          // the run is over; its clients end
};

struct StatePage {
  static constexpr char kName[] = "tcs-state";         // of the memfd
  static constexpr std::uint32_t kMagic = 0x64736374;  // "tcsd"
  static constexpr std::uint32_t kVersion = 1;
  static constexpr std::size_t kMostPath = 4096;

  // The coordinator, before anybody can find the page: a page cannot be found before it has its
  // magic.
  std::atomic<std::uint32_t> magic{0};  // last
  std::uint32_t version = kVersion;
  std::int32_t coordinator_pid = 0;  // its own number for itself
  std::int32_t wake_fd = -1;         // the pipe's write end, by its number there
  char folder[kMostPath] = {};       // of the run's results; empty: there is none

  // The coordinator, as it goes.
  std::atomic<Doing> doing{Doing::kPrepares};
  std::atomic<std::int32_t> host_cpu{-1};  // on which the run's threads take turns; -1: none yet
  std::atomic<std::uint64_t> since_tsc{0};
  std::atomic<std::int32_t> dispatched_tid{0};  // the last
  std::atomic<std::uint32_t> unused{0};
  std::atomic<std::uint64_t> dispatched_tsc{0};
  std::atomic<std::int64_t> virtual_ns{0};  // virtual; of that dispatch
  std::atomic<std::uint64_t> dispatches{0};

  // The asker.
  std::atomic<std::uint32_t> asked{0};

  // The coordinator.
  std::atomic<std::uint32_t> answered{0};
  std::atomic<std::uint64_t> text_size{0};  // kTooLong: there was no room
  static constexpr std::uint64_t kTooLong = UINT64_MAX;
};

static_assert(std::is_standard_layout_v<StatePage>);
static_assert(std::atomic<std::uint64_t>::is_always_lock_free);
static_assert(offsetof(StatePage, doing) == 16 + StatePage::kMostPath);
static_assert(sizeof(StatePage) == 4176);

// The text begins there. The text's pages cost nothing until they are used.
inline constexpr std::size_t kStateTextAt = 8192;
inline constexpr std::size_t kMostStateText = std::size_t{32} << 20;
static_assert(sizeof(StatePage) <= kStateTextAt);

}  // namespace tcs
