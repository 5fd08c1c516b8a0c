// The wait of a thread, as one value: a kind, with what belongs to that kind only, and what all
// kinds have. Waker::Wait and Waker::Leave (waker.h) begin and end the wait, so nothing of a wait
// outlives it.
//
// Nothing combines but what is here: every wait may end by its deadline, and a wait for descriptors
// may also end by a signal (ppoll and its kin with a mask; a read of a signalfd).
//
// Pure: threads are numbers (Task::order), times are their robots'. Not thread-safe.
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <variant>
#include <vector>

#include "coordinator/port/unique_fd.h"
#include "coordinator/queues/wait_queues.h"
#include "coordinator/tasks/kept_files.h"
#include "shm/layout.h"
#include "shm/time_kinds.h"

namespace tcs {

namespace awaited {

inline constexpr int kNobody = -1;

// Nothing at all: the thread's process is about to die, or the world goes on without the thread.
struct Nothing {};

// Only time, or a signal that the thread handles: sleeps, pause, sigsuspend.
struct Time {
  std::optional<std::uint64_t> mask;    // of signals, during the wait; bit 0 is signal 1
  std::uint64_t remaining_address = 0;  // where a sleep leaves what a signal cuts off; 0: nowhere
};

// Any signal of this set, which the thread accepts (sigwait).
struct Signals {
  std::uint64_t set = 0;
};

// Any of these descriptors, which the coordinator has in its epoll set.
struct Descriptors {
  std::vector<UniqueFd> fds;       // copies of the client's,
  std::vector<shm::WaitFd> asked;  // by which numbers, and for what, each was asked for
  shm::KeepFiles keep = shm::KeepFiles::kNot;
  DescriptorChanges since;    // of the process's when the wait began
  std::uint32_t number = 0;   // of the wait: tells its events from those of earlier waits
  std::uint64_t signals = 0;  // any of these signals ends the wait, too
  bool has_terminal = false;  // among the descriptors
  bool transfers = false;     // a trapped call that takes or gives data, and is to time out for it
  std::int64_t done = 0;      // of what it transfers
  // Of one descriptor, an event of which is for one of its waiting threads (one_waiter.cc):
  bool takes = false;
  bool last_is_first = false;     // for the thread that came last
  std::uint32_t events = 0;       // as epoll has them
  std::uint64_t order = 0;        // of waiting, over several attempts
  int passed_over_for = kNobody;  // the thread that the last event was for, until it has tried
  bool has_hidden = false;        // input at some is not to be seen yet (outside_waits.h);
  std::vector<UniqueFd> members;  // of an epoll set with such: the members that may be seen
  bool is_edge_armed = false;     // the descriptor tells of every further event,
  std::uint64_t skips_in = 0;     // but the event in this look of the reactor's is an old one
};

// The end of a child, or also its stop or continuation.
struct Child {
  pid_t which = 0;  // 0: any
  bool stops = false;

  bool MayBe(pid_t child) const { return which <= 0 || which == child; }
};

// A word in memory, at which FutexTable knows the thread.
struct Futex {
  // The thread that a join waits for, a robust lock's owner; 0: neither.
  pid_t names_tid = 0;
  std::uint64_t address = 0;  // of the word of such a wait, in the thread's memory,
  pid_t holds = 0;            // and the id in it, perhaps of a thread that is not known yet
  // Of a lock that lends priority:
  int owner = kNobody;
  std::uint64_t lock_address = 0;  // in the thread's memory
  bool was_requeued = false;       // the thread has been moved there from a condition
  std::size_t woken_word = 0;      // which of several words the thread was woken at
};

// A change of a kernel object that cannot be polled (WaitQueues).
struct Queue {
  KernelObject of;
};

// DDS messages, until the first is due.
struct Messages {};

// Until the process's deliverer of DDS messages has handed over what is due.
struct Deliverer {};

// Until this process, as the DDS hub numbers it, has taken some of the messages sent to it.
struct Room {
  std::uint32_t process = 0;
};

// Until another thread has run: the waiting thread spins where computing takes no time.
struct OthersRun {};

}  // namespace awaited

struct Wait {
  using What = std::variant<awaited::Nothing, awaited::Time, awaited::Signals, awaited::Descriptors,
                            awaited::Child, awaited::Futex, awaited::Queue, awaited::Messages,
                            awaited::Deliverer, awaited::Room, awaited::OthersRun>;

  What what;
  VirtualTime deadline = VirtualTime::Never();
  bool is_in_trapped_call = false;  // whose result its end decides
  bool is_date = false;             // the deadline moves when the date is set

  template <class Kind>
  const Kind* As() const {
    return std::get_if<Kind>(&what);
  }
  template <class Kind>
  Kind* As() {
    return std::get_if<Kind>(&what);
  }
};

// Whether a thread that goes on from the wait looks at what others have done. The thread must find
// all of that: it holds as at a read.
bool LooksAtOthers(const Wait& wait);
// Whether the wait may be ended from elsewhere on the robot, or from outside.
bool IsForInput(const Wait& wait);
// The signals that end the wait without a handler; bit 0 is signal 1.
std::uint64_t SignalsThatEnd(const Wait& wait);
// The mask that replaces the thread's own during the wait; none: the thread keeps its own.
std::optional<std::uint64_t> MaskOf(const Wait& wait);

// How many threads wait for events that are found only if somebody looks.
class WaitCounts {
 public:
  void Entered(const Wait& wait) { Count(wait, 1); }
  void Left(const Wait& wait) { Count(wait, -1); }

  int for_child() const { return for_child_; }
  int for_stops() const { return for_stops_; }  // of these: for a child's stop or continuation
  int for_signals() const { return for_signals_; }
  int for_room() const { return for_room_; }
  int for_deliverer() const { return for_deliverer_; }
  // For what other threads have to tell of: kernel objects, and what is written to terminals.
  int for_objects() const { return for_objects_; }
  // A waiter that is no thread waits for what is written to terminals, all the time.
  void EnteredForTerminals() { ++for_objects_; }

 private:
  void Count(const Wait& wait, int by);

  int for_child_ = 0, for_stops_ = 0, for_signals_ = 0, for_room_ = 0, for_deliverer_ = 0,
      for_objects_ = 0;
};

}  // namespace tcs
