// A further processor of the host, on which threads have short turns while the coordinator does
// something else: the coordinator begins such a turn, and looks later what it has come to. Neither
// the coordinator nor the thread sleeps for the other. Several turns may have begun; they run in
// that order, one by one.
//
//   Begin(thread)           the page is written; the thread leaves its gate, its clock begins then
//   HasSaid(thread)         the thread has stopped at its gate, and its note can be read
//   Take(thread)            the note is read
//   GiveUp(thread)          or the coordinator waits no longer: the note comes by the pipe
//   BringHome(thread)       the thread does not run on this processor any more
//
// A thread that has come here stays. The thread is held by its gate alone, at ordinary priority, so
// that it takes the processor from no other thread, and leaves no real-time thread when a process
// dies. Two threads of this process are here, too. The opener opens the gates. The opener runs when
// no other thread does, so that it opens the next gate when the last turn is over, and no wake-up
// from another processor interrupts a turn, which would be charged for that. The opener stays awake
// for as long as turns follow each other closely: a processor that sleeps takes the time of two
// turns to wake. The warden goes before all other threads, and sends home those that do not stop.
//
// For the coordinator's thread only.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <thread>

#include "coordinator/host/executor.h"
#include "coordinator/host/host_thread.h"

namespace tcs {

class BesideCpu {
 public:
  // Threads come from and go back to the processor `home`. `is_claimed`: whether another run has
  // claimed the processor of that number.
  BesideCpu(int cpu, int home, double ticks_per_ns, Executor& executor,
            std::function<bool(int)> is_claimed);
  ~BesideCpu();
  BesideCpu(const BesideCpu&) = delete;
  BesideCpu& operator=(const BesideCpu&) = delete;

  int cpu() const { return cpu_; }
  // False while others need the processor: no turn is to begin here at `tsc`.
  bool IsFreeAt(std::uint64_t tsc);
  // True if turns have begun here one after the other of late: the processor is of use.
  bool IsBusyAt(std::uint64_t tsc) const;
  // A turn would have begun, but for other threads that are here.
  void NoteWanted(std::uint64_t tsc);
  // Turns that have begun and were neither taken nor given up.
  int begun() const { return begun_; }

  // The thread is at its gate, and not dispatched. False if the kernel does not let it come here.
  bool Begin(HostThread& thread);
  static bool HasSaid(const HostThread& thread);
  // The TSC at which the thread stopped, by its own word: no earlier than its turn began, and no
  // later than now.
  static std::uint64_t StoppedAt(const HostThread& thread);
  void Take(HostThread& thread);
  // False if the thread has said something just now.
  bool GiveUp(HostThread& thread);
  // The thread has ended.
  void Forget(HostThread& thread);
  // Where the thread computes, this process busy-waits until the thread has stopped: it does not
  // sleep.
  void BringHome(HostThread& thread);
  // Other threads had the processor: no turn begins here for some time. That time is twice as long
  // if they had the processor again within as long as it was left to them before.
  void LeaveToOthers(std::uint64_t tsc);

 private:
  void Start();
  void OpenGates();
  bool OpenNext();
  void AwaitOpener();
  bool TakeBack(const HostThread& thread);
  void SendHomeWhenAsked();
  void Wake(std::atomic<std::uint32_t>& word);
  std::uint64_t TicksIn(std::int64_t ns) const;

  const int cpu_, home_;
  const double ticks_per_ns_;
  Executor& executor_;
  const std::function<bool(int)> is_claimed_;
  int begun_ = 0;
  std::array<std::uint64_t, 8> begun_tsc_{};  // the last turns
  std::size_t next_begun_ = 0;
  int left_to_others_ = 0;        // in a row
  std::uint64_t left_ticks_ = 0;  // the last time
  std::uint64_t not_before_tsc_ = 0, looks_for_claims_tsc_ = 0;

  std::atomic<bool> ends_{false};
  std::atomic<std::uint64_t> awake_until_tsc_{0};
  // The gates that are to be opened, in a ring. An entry becomes null when the opener takes it, or
  // the coordinator takes it back.
  static constexpr std::size_t kMostGates = 16;
  std::array<std::atomic<shm::ThreadSlot*>, kMostGates> gates_{};
  std::atomic<std::uint64_t> asked_{0};
  std::uint64_t opened_ = 0;        // the opener's
  std::atomic<bool> opens_{false};  // the opener opens a gate, just now
  std::atomic<pid_t> opener_tid_{0};
  std::atomic<std::uint32_t> sleeps_{0};  // 1: the opener sleeps, at this word
  // The thread that is to be sent home; 0: none. With kSends the warden sends it home, just now.
  std::atomic<std::uint32_t> sends_{0};
  std::thread opener_, warden_;
};

}  // namespace tcs
