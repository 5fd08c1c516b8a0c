// What threads of simulated programs do, for ever, as their seeds say: they compute, read clocks,
// sleep, lock, read and write, and stand in the kernel in calls that nobody is told of. They are
// the shim's guests as any program's threads are: what they do goes through the shim's own sources.
#pragma once

#include <signal.h>

#include <cstdint>
#include <deque>
#include <vector>

#include "libtcs_preload/guest.h"
#include "tests/simulate/kernel.h"
#include "tests/simulate/luck.h"

namespace tcs::simulate {

// A lock as the C library's: a word, at which those sleep that find it taken.
struct SimLock {
  std::atomic<std::uint32_t> word{0};
  std::int64_t released_ns = 0;  // by the clock of whoever released it last
  const void* holder = nullptr;
  std::vector<std::int64_t> woken_ns;  // when those were woken who slept, likewise,
  std::size_t wakes_done = 0;          // and how many of these calls are over
};

// What all threads write to and read from, as if it were a file: when last, by the clocks of those
// who did, and so what nobody may find changed any more, or not yet there.
struct SimFile {
  std::int64_t written_ns = 0, read_ns = 0;
};

// A thread's timer, and how often it has been told of an expiration of the present setting.
struct SimTimer {
  int number = -1;  // there is none yet
  std::int64_t first_ns = INT64_MAX;
  std::int64_t interval_ns = 0, told = 0;
  int signals = 0;  // of this setting
  // A signal of the setting before may still come.
  bool may_be_stale = false;
  // The setting is being changed, or a signal came while it was: nobody knows of which one.
  bool is_unknown = true;

  // When the next one is that it has not been told of; INT64_MAX: there is none.
  std::int64_t NextNs() const;
};

// What may be done, and what must hold besides.
struct ProgramRules {
  bool has_kernel_waits = false, has_signals = false, has_timers = false;
  bool is_hostile = false;  // it writes into its slot, and nothing that it does need hold
  // Each thread of its robot has a core for itself: nobody waits for one.
  bool has_own_core = false;
  std::int64_t drift_bound_ns = 0;
  // What a thread's clock may show beyond the end of a sleep: what it computes before it looks, and
  // what others had of its processor since its clock was last checked.
  std::int64_t slack_ns = 5'000 + 100'000;
  // By how much a clock may be ahead of what its thread does: by what others had of its processor
  // since it was last checked. On the slowest computer; nothing of set costs.
  std::int64_t call_ns = 0;
};

class SimProgram {
 public:
  SimProgram(std::uint64_t seed, const ProgramRules& rules, std::deque<SimLock>& locks,
             SimFile& file)
      : luck_(seed), rules_(rules), locks_(locks), file_(file) {}

  // Those that it sends signals to: of all processes, itself too.
  void Knows(std::vector<SimThread*> others) { others_ = std::move(others); }
  // The thread's body.
  [[noreturn]] void Run(preload::GuestThread guest);

  // What it does is what honest programs do.
  bool MustHold() const { return !rules_.is_hostile; }
  // What its clock showed after each thing that it did.
  const std::vector<std::int64_t>& shown() const { return shown_; }

 private:
  std::int64_t LookAtClock();
  void Sleep();
  void AwaitRelease(SimLock& lock);
  void Lock(SimLock& lock);
  void Unlock(SimLock& lock);
  void UseLock();
  void WriteToFile();
  void ReadFile();
  void SendSignal();
  void UseTimer();
  void ChangeTimer(std::int64_t after_ns, std::int64_t interval_ns);
  void NoteTold(std::int64_t count, std::int64_t now_ns);
  void CheckTimer(std::int64_t now_ns) const;
  static void OnTimer(int signal, siginfo_t* info, void* context);
  void Scribble();
  void Cheat();
  static void OnSignal(int signal, siginfo_t* info, void* context);
  static void HandleSignals();
  void Act();
  void Note(std::int64_t now_ns);

  Luck luck_;
  const ProgramRules rules_;
  std::deque<SimLock>& locks_;
  SimFile& file_;
  std::vector<std::int64_t> shown_;
  std::vector<SimThread*> others_;
  SimTimer timer_;
  int handled_ = 0;  // signals
  // By its clock, when it began to handle the first one since its last sleep began.
  std::int64_t first_handled_ns_ = 0;
  std::int64_t last_ns_ = 0;
};

}  // namespace tcs::simulate
