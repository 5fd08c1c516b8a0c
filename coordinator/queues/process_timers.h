// The timers of one process: the three of setitimer, timer descriptors, and the timers of
// timer_create.
//
// A timer runs on the clock of its process, or on processor time, of the process or of one thread.
// A caller sets and reads times of that clock. The instants of Expire, EndRests, NextExpiry and
// NextLook are the virtual CPU's; the process's clock is ahead of it by the lead that the clock had
// when the timer was set (--sync callback).
//
// - All timers that are due at an instant run out at once. A timer without an interval is then not
//   armed any more; any other is set to its first time after the instant. The end of all time
//   (shm::kNeverNs) never comes.
// - A timer of timer_create has one signal on its way at a time. Expirations before that signal is
//   accepted are its overruns, INT_MAX at most. The timers of setitimer have one signal of each
//   number on its way.
// - A short interval (shm::kShortIntervalNs) is not processed expiration by expiration. A thread
//   that waits for such a timer is woken at its instant. But an expiration before the process has
//   run again changes nothing that can be seen except a count: until then the timer rests, and the
//   count is made up at once. While the process runs the timer is looked at now and then, for the
//   sake of its signal.
//
// Pure: makes no system call. The class returns which timers have run out and which signals are to
// be sent. The caller tells it whether a signal was accepted. Not thread-safe.
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "shm/layout.h"
#include "shm/time_kinds.h"

namespace tcs {

// A timer's signal on its way.
struct TimerSignal {
  int number = 0;
  pid_t tid = 0;              // 0: to the process
  std::int64_t timer_id = 0;  // 0: setitimer's
  std::int64_t value = 0, overruns = 0;
  pid_t computed = 0;  // on processor time: the thread by which the timer has run out
  pid_t taker = 0;     // the thread that will run the handler: sent at its next dispatch
};

class ProcessTimers {
 public:
  using Id = std::int64_t;
  // Beside setitimer's. Natively the process's limits (RLIMIT_SIGPENDING, RLIMIT_NOFILE) are about
  // the same.
  static constexpr std::size_t kMost = 16'384;

  // Timers beside setitimer's, of the process itself: the time that it may compute until it is told
  // so (SIGXCPU), and at all (SIGKILL). Programs have no number for these timers.
  static constexpr Id kCpuLimit = 3, kMostCpu = 4;
  static_assert(kMostCpu < shm::kFirstTimerId);

  struct Setting {
    std::int64_t next_ns = 0;  // 0: not armed
    std::int64_t interval_ns = 0;
    bool is_date = false;  // next_ns moves when the date is set
  };
  struct RanOut {
    Id id;
    std::int64_t count;
    std::optional<ProgramTime> shown;  // on its process's clock; none: it is on CPU time
    bool is_periodic;
  };
  // Processor time used, by the process and one of its threads.
  struct CpuUsed {
    VirtualDuration process;
    pid_t tid;
    VirtualDuration thread;
  };
  struct SentSignal {
    Id timer_id;
    int number;
    pid_t to;  // 0: the process
  };

  // setitimer's are there without being created, and are not deleted.
  bool IsFull() const;
  Id next_id() const { return next_id_; }
  // Must not be full.
  Id Create(const shm::TimerKind& kind);
  // Deletes the timer with its signal, unless the signal was sent.
  void Delete(Id id);
  // The timers of timer_create, which end when the process executes another program.
  void DeletePosix();

  // None: there is no such timer. The functions below then return 0, or do nothing.
  std::optional<shm::TimerKind> KindOf(Id id) const;
  Setting Get(Id id) const;
  // The timers that are armed, by their ids.
  struct Armed {
    Id id;
    Setting setting;
    shm::TimerKind kind;
  };
  std::vector<Armed> AllArmed() const;
  // Forgets the timer's earlier setting and its signal's overruns, but not a signal that is on its
  // way.
  void Set(Id id, Setting setting, VirtualDuration lead);
  // The date has been set, so much forward, at `now`.
  void MoveDates(std::int64_t forward_ns, VirtualTime now);

  // When the next timer on the process's clock runs out.
  VirtualTime NextExpiry() const { return next_expiry_; }
  // The owner of that value is told when it changes.
  void TellOfNextExpiry(std::function<void()> listener) { listener_ = std::move(listener); }
  std::vector<RanOut> Expire(VirtualTime now);
  // Whether the timer is of a short interval and has run out by `now`: the caller that needs to see
  // that calls Expire.
  bool IsBehind(Id id, VirtualTime now) const;

  // The timers on processor time: the time that may still be used before the next one runs out;
  // none: any amount. It is at least 1 us, as a timer that has run out already is found when the
  // thread has run.
  bool HasCpuTimers() const { return has_cpu_timers_; }
  std::optional<VirtualDuration> CpuTimeToExpiry(const CpuUsed& used) const;
  std::vector<RanOut> ExpireCpu(const CpuUsed& used);

  // A thread of the process has run until `now`, and may have read a timer, or handled its signal.
  void EndRests(VirtualTime now);
  // How far a thread of the process may run before the resting timers are looked at again.
  VirtualTime NextLook() const;

  // Signals that are to be sent, in the order in which they came about: takes them all. The caller
  // either sends a signal or gives it back.
  bool HasSignals() const { return !signals_.empty(); }
  std::vector<TimerSignal> TakeSignals();
  void GiveBack(const TimerSignal& signal) { signals_.push_back(signal); }
  void NoteSent(const TimerSignal& signal, pid_t to);
  // Of timer_create's timers: the signals that were sent and not yet seen accepted.
  std::vector<SentSignal> SentSignals() const;
  // The signal was seen at `now` to be accepted. Earlier expirations of a short interval's timer,
  // while nobody looked at it, belong to the accepted signal.
  void Accept(Id id, VirtualTime now);
  // The signal did nothing, and no thread has accepted it: the overruns are those of the signal
  // before.
  void Lost(Id id);
  // The same by the thread that has just accepted the signal: the expirations until now belong to
  // the accepted signal. Where that signal was seen accepted before the thread could say so, and
  // the next signal is pending already, the next signal is still to be accepted.
  void AcceptAt(Id id, VirtualTime now, bool is_pending);
  // The overruns of the signal that was accepted last.
  std::int64_t Overruns(Id id) const;

 private:
  struct Timer {
    shm::TimerKind kind;
    Setting setting;
    VirtualDuration lead;             // of the process's clock when the timer was set
    bool is_signal_underway = false;  // the signal was not seen accepted yet
    std::int64_t overruns = 0;        // of that signal
    std::int64_t accepted_overruns = 0;
    bool was_seen_accepted = false;  // the last signal, before its thread has said so
    pid_t sent_to = 0;
    bool rests = false;
    std::int64_t seen_ns = 0;  // when the timer was last looked at, on its clock

    bool IsArmed() const { return setting.next_ns != 0; }
    bool IsOnCpuTime() const { return kind.clock != shm::TimerClock::kTime; }
    bool IsShort() const;
    VirtualTime NextOnVirtualCpu() const;
    std::int64_t TakeExpirations(std::int64_t clock_ns);
    std::int64_t CpuTimeLeft(std::int64_t used_ns) const;
    void AddOverruns(std::int64_t count);
    void Accept();
  };

  // The time on the timer's clock, none if that is another thread's clock.
  static std::optional<VirtualDuration> CpuClockOf(const Timer& timer, const CpuUsed& used);
  const Timer* Find(Id id) const;
  Timer* Find(Id id);
  bool IsUnsent(Id id) const;
  void Signal(Id id, Timer& timer, std::int64_t count, pid_t computed = 0);
  void FindNext(VirtualTime earliest = {});

  std::map<Id, Timer> timers_;
  Id next_id_ = shm::kFirstTimerId;
  std::vector<TimerSignal> signals_;
  VirtualTime next_expiry_ = VirtualTime::Never();
  std::function<void()> listener_;
  bool has_cpu_timers_ = false;
  bool has_resting_timers_ = false;
};

}  // namespace tcs
