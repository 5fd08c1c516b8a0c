// One processor of the host, on which the threads of a run take turns: how one of them is made to
// run and to stop there, and what its clock shows meanwhile. Which one, and how far, the scheduler
// decides.
//
// The coordinator is on the same processor and goes before all of them. So a thread runs while the
// coordinator sleeps, and stops when it wakes:
//
//   Dispatch(thread)        it may run, and the one before it is held; the detector is armed
//   OpenGate(slot)          where it waits there
//   Start(thread)           its clock runs: the coordinator sleeps next
//   loop
//     Woke()                the coordinator is back, the thread stopped
//     Continue(thread)      or only interrupted: its clock goes on, and the coordinator sleeps
//   End(thread, page)       a copy of its clock page says what its run has come to
//
// Several of these know nothing of each other. For the coordinator's thread only.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "coordinator/host/active_threads.h"
#include "coordinator/host/executor.h"
#include "coordinator/host/host_thread.h"
#include "coordinator/host/ideal_meter.h"
#include "coordinator/host/meter.h"
#include "coordinator/port/block_detector.h"
#include "coordinator/port/thread_signals.h"
#include "shm/clock_page.h"
#include "shm/layout.h"

namespace tcs {

class HostCpu {
 public:
  // ideal_patience: after which a thread of an ideal robot is found silent.
  HostCpu(Executor& executor, HostDuration ideal_patience)
      : executor_(executor), active_(executor), ideal_meter_(ideal_patience) {}

  // Before all else. Makes the detector's process.
  [[nodiscard]] std::string Open(std::unique_ptr<Meter> meter);

  // False if the dispatched thread shares the processor with the coordinator and with others
  // (executor.h): its own CPU clock alone tells what it has computed, and it has stopped once it
  // says so. Where Woke() is said to be its stop, it may run on.
  bool stands_still() const { return executor_.StandsStill(); }
  // Of a process, and in its last dispatch.
  static void SendToGate(pid_t pid, const HostThread& thread) {
    tcs::SendToGate(pid, thread.tid, shm::DispatchNumber(thread.DispatchWord()));
  }

  // Who else may run, and who has ended.
  ActiveThreads& active() { return active_; }
  BlockDetector& detector() { return detector_; }
  // What the thread's clock is to count from its next dispatch on.
  void SetRates(const HostThread& thread, const Meter::SetCosts& costs, ClockGrant& grant) {
    MeterOf(thread).SetRates(thread.metered, costs, grant);
  }

  void Dispatch(HostThread& thread);
  static void OpenGate(shm::ThreadSlot& slot);
  // `is_silent`: so it was found when it last ran (meter.h).
  void Start(HostThread& thread, bool is_silent);
  void Woke();
  // The thread whose turn ends next stopped then, on another processor.
  void WokeAt(std::uint64_t tsc) { stop_tsc_ = tsc; }
  // Its clock begins at `tsc`, on another processor, or once it leaves its gate there.
  void StartBeside(HostThread& thread, std::uint64_t tsc);
  void Continue(HostThread& thread);
  // `page`: a copy of the thread's, which the thread's process may change meanwhile.
  void End(HostThread& thread, const Meter::CpuClock& clock, shm::ClockPage* page);

  // The TSC when the coordinator last woke, or let a thread run.
  std::uint64_t stop_tsc() const { return stop_tsc_; }
  // The clock of a thread that has registered, as it was then.
  shm::ClockReading ClockOf(const HostThread& thread) const;

  // For how much real time the coordinator may sleep until it has to look at the thread, whose
  // clock's horizon that is; and what it finds when it has slept for as long.
  HostDuration TimeToLook(HostThread& thread, ProgramTime horizon);
  Meter::Found Look(HostThread& thread, ProgramTime horizon, const Meter::CpuClock& clock);

  // The coordinator was to sleep for `asked`, from when the thread's clock was at `before` on.
  // What was stolen meanwhile, and no clock tells of, is taken out. Returns it.
  HostDuration TakeOutUnaccounted(HostThread& thread, const shm::ClockReading& before,
                                  HostDuration asked, const Meter::CpuClock& clock);
  // Of a thread that ran on though another one was dispatched.
  void Check(HostThread& thread, const Meter::CpuClock& clock);
  // What the thread has moved the origin of its CPU clock by, on its ways out of gates, is its own
  // from now on: what these can have taken, that is.
  static void FollowOrigin(HostThread& thread);
  // It goes out of a gate next, and may say what that took.
  static void AllowWay(HostThread& thread);
  // It goes out of its first one, and has had a broker made on the way.
  static void AllowAttach(HostThread& thread);
  // What a thread has computed since it was last charged `charged`, by its CPU clock: while it was
  // not dispatched.
  static VirtualDuration Uncharged(const HostThread& thread, VirtualDuration charged,
                                   const Meter::CpuClock& clock);
  // A thread that was charged so much at its note, on another processor, has come to its gate there
  // since: that way is ours, as the shim has it where the next turn is there, too (LeaveGate).
  static void TakeOutWayToGate(HostThread& thread, VirtualDuration charged,
                               const Meter::CpuClock& clock);
  // Of a thread that has stopped in a system call that its shim knows nothing of; `page` as in End.
  void ChargeCall(HostThread& thread, VirtualDuration cost, shm::ClockPage* page);

 private:
  Meter& MeterOf(const HostThread& thread) {
    return thread.metered.is_ideal ? static_cast<Meter&>(ideal_meter_) : *meter_;
  }

  Executor& executor_;
  ActiveThreads active_;
  BlockDetector detector_;
  std::unique_ptr<Meter> meter_;
  IdealMeter ideal_meter_;
  bool from_gate_ = false;  // the thread that was dispatched last
  std::uint64_t stop_tsc_ = 0;
};

}  // namespace tcs
