// The descriptors that the coordinator waits at: an epoll set, and for each kind of descriptor the
// handler of its events. The reactor takes what the kernel has into a queue and hands it on in that
// order; a handler says what it has found, and waiting for events in one is a bug.
//
// Not thread-safe. Descriptors stay their owners'.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>

#include "coordinator/port/unique_fd.h"
#include "coordinator/tasks/event_time.h"

namespace tcs {

// The kinds of descriptors.
enum class Tag : std::uint32_t {
  kPipe,
  kListener,
  kConnection,
  kProcess,
  kAwaited,
  kUnregisteredChild,
  kTrap,
  kCommand,
  kNetwork,
  kSignal,
  kGraceRanOut,
  kDetector,
  kDetectorEnd,
  kStateAsked,
  kOutside,
  kCount
};

// The subject of the events at a descriptor. Fits into the data that epoll keeps with a descriptor.
struct Subject {
  static constexpr std::uint32_t kNumberMask = 0xffffff;

  Tag tag = Tag::kPipe;
  std::uint32_t index = 0;
  std::uint32_t number = 0;  // tells events of this wait from those of earlier ones; 24 bits count

  bool operator==(const Subject&) const = default;
};

// The findings of handlers, together.
struct PollOutcome {
  bool stops_running = false;   // the running thread has to be stopped
  bool wakes_others = false;    // a thread may act now that could not before
  bool blocks_running = false;  // the kernel holds the running thread
  bool looks_again = false;     // there may be more by now that belongs to this moment
  PollOutcome& operator|=(const PollOutcome& other);
};

class Reactor {
 public:
  // `events` as epoll has them.
  using Handler = std::function<PollOutcome(const Subject&, std::uint32_t events, EventTime)>;

  Reactor();
  Reactor(const Reactor&) = delete;
  Reactor& operator=(const Reactor&) = delete;

  void On(Tag tag, Handler handler);

  // False: errno is set (ENOENT, EEXIST and the like, as epoll_ctl has it).
  bool Add(int fd, std::uint32_t events, const Subject& subject);
  bool Modify(int fd, std::uint32_t events, const Subject& subject);
  // Nothing happens if the descriptor is not there.
  void Remove(int fd);

  // Waits until there is an event, at most so long (negative: without limit), and
  // queues what there is. Returns the number of events.
  std::size_t Wait(HostDuration timeout);
  // True if the kernel may have more at this instant than the last wait took.
  bool IsFull() const { return is_full_; }
  // The number of the look that the next wait takes, or completes: a look is all that the kernel
  // has at an instant, in as many waits as that takes.
  std::uint64_t next_look() const { return next_look_; }
  // True if an event has come since that the next wait takes.
  bool HasMore() const;
  // Has the queued events handled, all of them at that moment.
  PollOutcome Handle(EventTime when);

 private:
  static constexpr std::size_t kAtOnce = 64;

  struct Queued {
    Subject subject;
    std::uint32_t events;
  };

  UniqueFd epoll_;
  bool is_full_ = false, is_handling_ = false;
  std::uint64_t next_look_ = 1;
  std::array<Queued, kAtOnce> queue_;
  std::size_t count_ = 0;  // in queue_
  std::array<Handler, static_cast<std::size_t>(Tag::kCount)> handlers_;
};

// The outcome of an event that may concern anybody.
inline constexpr PollOutcome kConcernsAll{.stops_running = true, .wakes_others = true};

}  // namespace tcs
