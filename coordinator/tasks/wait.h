// What a thread waits for, as one value: a kind, with what belongs to that kind only, and what all
// kinds have. Waker::Wait and Waker::Leave (waker.h) begin and end it, so nothing of a
// wait outlives it.
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
  std::optional<std::uint64_t> mask;    // of signals, as long as it waits; bit 0 is signal 1
  std::uint64_t remaining_address = 0;  // where a sleep leaves what a signal cuts off; 0: nowhere
};

// One of these signals, which the thread accepts (sigwait).
struct Signals {
  std::uint64_t set = 0;
};

// One of these descriptors, which the coordinator has in its epoll set.
struct Descriptors {
  std::vector<UniqueFd> fds;       // copies of the client's,
  std::vector<shm::WaitFd> asked;  // by which numbers, and for what, each was asked for
  shm::KeepFiles keep = shm::KeepFiles::kNot;
  DescriptorChanges since;    // of the process's when the wait began
  std::uint32_t number = 0;   // of the wait: tells its events from those of earlier waits
  std::uint64_t signals = 0;  // one of these ends the wait, too
  bool has_terminal = false;  // among the descriptors
  bool transfers = false;     // a trapped call that takes or gives data, and is to time out for it
  std::int64_t done = 0;      // of what it transfers
  // Of one descriptor, an event of which is for one of those that wait for it (one_waiter.cc):
  bool takes = false;
  bool last_is_first = false;     // for the one that came last
  std::uint32_t events = 0;       // as epoll has them
  std::uint64_t order = 0;        // of waiting, over several attempts
  int passed_over_for = kNobody;  // the thread that the last event was for, until it has tried
  bool has_hidden = false;        // what comes by some is not to be seen yet (outside_waits.h);
  std::vector<UniqueFd> members;  // of an epoll set with such: those that may be seen
  bool is_edge_armed = false;     // the descriptor tells of every further event,
  std::uint64_t skips_in = 0;     // and the one in this look of the reactor's is of what was there
};

// That a child ends, or also that it stops or goes on.
struct Child {
  pid_t which = 0;  // 0: any
  bool stops = false;

  bool MayBe(pid_t child) const { return which <= 0 || which == child; }
};

// A word in memory, at which FutexTable knows it.
struct Futex {
  // The thread that a join waits for, a robust lock's owner; 0: neither.
  pid_t names_tid = 0;
  std::uint64_t address = 0;  // of the word of such a wait, in the thread's memory,
  pid_t holds = 0;            // and what may be the id of a thread that is not known yet
  // Of a lock that lends priority:
  int owner = kNobody;
  std::uint64_t lock_address = 0;  // in the thread's memory
  bool was_requeued = false;       // it has been moved there from a condition
  std::size_t woken_word = 0;      // which of several it was woken at
};

// That somebody changes a kernel object that cannot be polled (WaitQueues).
struct Queue {
  KernelObject of;
};

// DDS messages, until the first is due.
struct Messages {};

// That what is due has been handed over by its process's deliverer of DDS messages.
struct Deliverer {};

// That this process, as the DDS hub numbers it, has taken some of what was sent to it.
struct Room {
  std::uint32_t process = 0;
};

// That another thread has run: it spins where computing takes no time.
struct OthersRun {};

}  // namespace awaited

struct Wait {
  using What = std::variant<awaited::Nothing, awaited::Time, awaited::Signals, awaited::Descriptors,
                            awaited::Child, awaited::Futex, awaited::Queue, awaited::Messages,
                            awaited::Deliverer, awaited::Room, awaited::OthersRun>;

  What what;
  VirtualTime deadline = VirtualTime::Never();
  bool is_in_trapped_call = false;  // whose result its end decides
  bool is_date = false;             // the deadline: it moves when the date is set

  template <class Kind>
  const Kind* As() const {
    return std::get_if<Kind>(&what);
  }
  template <class Kind>
  Kind* As() {
    return std::get_if<Kind>(&what);
  }
};

// Whoever goes on from such a wait looks at what others have done, and must find all of it: it
// holds as at a read.
bool LooksAtOthers(const Wait& wait);
// What ends the wait may come from elsewhere on the robot, or from outside.
bool IsForInput(const Wait& wait);
// The signals that end it without a handler; bit 0 is signal 1.
std::uint64_t SignalsThatEnd(const Wait& wait);
// The mask that the thread's own gives way to meanwhile; none: it keeps its own.
std::optional<std::uint64_t> MaskOf(const Wait& wait);

// How many threads wait for what only somebody's looking finds.
class WaitCounts {
 public:
  void Entered(const Wait& wait) { Count(wait, 1); }
  void Left(const Wait& wait) { Count(wait, -1); }

  int for_child() const { return for_child_; }
  int for_stops() const { return for_stops_; }  // of those: that a child stops or goes on
  int for_signals() const { return for_signals_; }
  int for_room() const { return for_room_; }
  int for_deliverer() const { return for_deliverer_; }
  // For what others have to tell of: kernel objects, and what is written to terminals.
  int for_objects() const { return for_objects_; }
  // Somebody who is no thread waits for what is written to terminals, all the time.
  void EnteredForTerminals() { ++for_objects_; }

 private:
  void Count(const Wait& wait, int by);

  int for_child_ = 0, for_stops_ = 0, for_signals_ = 0, for_room_ = 0, for_deliverer_ = 0,
      for_objects_ = 0;
};

}  // namespace tcs
