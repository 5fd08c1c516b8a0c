// One processor of the host, on which the threads of a run take turns: how a thread is made to run
// and to stop there, and what its clock shows meanwhile. The scheduler decides which thread, and
// how far.
//
// The coordinator is on the same processor and goes before all of these threads. So a thread runs
// while the coordinator sleeps, and stops when the coordinator wakes:
//
//   Dispatch(thread)        the thread may run, the one before it is held; the detector is armed
//   OpenGate(slot)          where the thread waits at its gate
//   Start(thread)           the thread's clock runs: the coordinator sleeps next
//   loop
//     Woke()                the coordinator is back, the thread stopped
//     Continue(thread)      or only interrupted: the thread's clock goes on, the coordinator sleeps
//   End(thread, page)       a copy of the thread's clock page says what the run has come to
//
// Several objects of this class know nothing of each other. For the coordinator's thread only.
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
  // (executor.h): the thread's own CPU clock alone tells what it has computed, and the thread has
  // stopped once it says so. Where Woke() is said to be its stop, the thread may run on.
  bool stands_still() const { return executor_.StandsStill(); }
  // For a thread of the process `pid`, and for the thread's last dispatch.
  static void SendToGate(pid_t pid, const HostThread& thread) {
    tcs::SendToGate(pid, thread.tid, shm::DispatchNumber(thread.DispatchWord()));
  }

  // The other threads that may run, and the threads that have ended.
  ActiveThreads& active() { return active_; }
  BlockDetector& detector() { return detector_; }
  // Sets what the thread's clock is to count from the next dispatch on.
  void SetRates(const HostThread& thread, const Meter::SetCosts& costs, ClockGrant& grant) {
    MeterOf(thread).SetRates(thread.metered, costs, grant);
  }

  void Dispatch(HostThread& thread);
  static void OpenGate(shm::ThreadSlot& slot);
  // `is_silent`: the thread was found silent when it last ran (meter.h).
  void Start(HostThread& thread, bool is_silent);
  void Woke();
  // The thread whose turn ends next stopped then, on another processor.
  void WokeAt(std::uint64_t tsc) { stop_tsc_ = tsc; }
  // The thread's clock begins at `tsc`, on another processor, or once the thread leaves its gate
  // there.
  void StartBeside(HostThread& thread, std::uint64_t tsc);
  void Continue(HostThread& thread);
  // `page`: a copy of the thread's, which the thread's process may change meanwhile.
  void End(HostThread& thread, const Meter::CpuClock& clock, shm::ClockPage* page);

  // The TSC when the coordinator last woke, or let a thread run.
  std::uint64_t stop_tsc() const { return stop_tsc_; }
  // The clock of a thread that has registered, as it was then.
  shm::ClockReading ClockOf(const HostThread& thread) const;

  // The real time for which the coordinator may sleep until it has to look at the thread, whose
  // clock's horizon that is; and what the coordinator finds when it has slept for as long.
  HostDuration TimeToLook(HostThread& thread, ProgramTime horizon);
  Meter::Found Look(HostThread& thread, ProgramTime horizon, const Meter::CpuClock& clock);

  // The coordinator was to sleep for `asked`, from when the thread's clock was at `before` on. The
  // time that was stolen meanwhile, and that no clock tells of, is taken out. Returns that time.
  HostDuration TakeOutUnaccounted(HostThread& thread, const shm::ClockReading& before,
                                  HostDuration asked, const Meter::CpuClock& clock);
  // For a thread that ran on though another one was dispatched.
  void Check(HostThread& thread, const Meter::CpuClock& clock);
  // Accepts the amount by which the thread has moved the origin of its CPU clock, for its ways out
  // of gates and the shim's own work in calls: as much as these can have taken.
  static void FollowOrigin(HostThread& thread);
  // The thread goes out of a gate next, and may say what that took.
  static void AllowWay(HostThread& thread);
  // The thread goes out of its first gate, and has had a broker made on the way.
  static void AllowAttach(HostThread& thread);
  // The time that a thread has computed since it was last charged `charged`, by its CPU clock:
  // while the thread was not dispatched.
  static VirtualDuration Uncharged(const HostThread& thread, VirtualDuration charged,
                                   const Meter::CpuClock& clock);
  // A thread that was charged `charged` at its note, on another processor, has come to its gate
  // there since: the way to the gate is tcs's, not the thread's, as the shim has it where the next
  // turn is there, too (LeaveGate).
  static void TakeOutWayToGate(HostThread& thread, VirtualDuration charged,
                               const Meter::CpuClock& clock);
  // For a thread that has stopped in a system call that its shim knows nothing of; `page` as in
  // End.
  void ChargeCall(HostThread& thread, VirtualDuration cost, shm::ClockPage* page);

 private:
  HostDuration RanInTurn(const HostThread& thread, const Meter::CpuClock& clock) const;
  void AllowOwnWork(HostThread& thread, const Meter::CpuClock& clock) const;
  Meter& MeterOf(const HostThread& thread) {
    return thread.metered.is_ideal ? static_cast<Meter&>(ideal_meter_) : *meter_;
  }

  Executor& executor_;
  ActiveThreads active_;
  BlockDetector detector_;
  std::unique_ptr<Meter> meter_;
  IdealMeter ideal_meter_;
  bool from_gate_ = false;  // the thread that was dispatched last was at its gate
  std::uint64_t stop_tsc_ = 0;
};

}  // namespace tcs
