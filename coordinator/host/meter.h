// A meter says what a thread's runs are charged: the time that they take (measured_meter.h), or set
// costs (fixed_meter.h). With that the meter knows for how long a thread may run before the
// coordinator looks at it again.
//
// The charge is on the thread's clock page, which the thread reads and moves, too
// (shm/clock_page.h); a meter touches it only while the thread is stopped. Times on the page are
// virtual and of the thread's process; horizons here are, too. A meter makes no system call: the
// values of the TSC and of the thread's CPU clock are arguments. A meter learns what switches and
// timers take on one processor of the host, so that each processor has a meter of its own. Not
// thread-safe.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <optional>

#include "coordinator/host/clock_grant.h"
#include "coordinator/host/own_work.h"
#include "coordinator/host/switch_costs.h"
#include "shm/clock_page.h"
#include "shm/layout.h"
#include "shm/time_kinds.h"

namespace tcs {

// Of the TSC, which all processors of the host share.
struct TscRate {
  std::uint64_t ns_per_tick_q32 = std::uint64_t{1} << 32;
  double ticks_per_ns = 1.0;
};

// The state that a meter keeps of one thread.
struct MeteredThread {
  shm::ClockPage* page = nullptr;
  double speed = 1.0;     // the host's nanoseconds per virtual one
  bool is_ideal = false;  // the thread is charged nothing (ideal_meter.h)
  // The value of the thread's CPU clock when its charge was 0, moved by what is not charged, and by
  // what is charged without being computed.
  static constexpr std::int64_t kNoOrigin = INT64_MIN;  // not known yet
  std::int64_t host_origin_ns = kNoOrigin;
  std::int64_t page_origin_ns = 0;  // the same, as the page says it
  std::int64_t known_cpu_ns = -1;   // the CPU clock's last value (shared_cpu_meter.h)
  std::int64_t turn_cpu_ns = -1;    // that when the turn began
  HostDuration least_sleep;         // before the next look at the thread (likewise)
  HostDuration longest_run = HostDuration::Milliseconds(10);  // of late
  // Other threads look at what this thread does in short steps: its CPU clock is asked after each
  // turn.
  bool is_watched = false;
  // The time that the thread's ways out of gates may still have taken: the thread says so itself,
  // and is not charged for it.
  HostDuration most_ways;
  OwnWork own_work;              // the shim's, in the thread's calls
  HostDuration own_work_in_all;  // that, and what the ways to the coordinator and back have taken
  std::uint64_t unchecked_ticks = 0;  // of TSC run since its CPU clock was last asked
  std::uint64_t unaudited_ticks = 0;  // the same, by the coordinator
  bool can_be_audited = true;         // in this turn: where the thread stops it stands still
  std::uint64_t checked_tsc = 0;      // the page's last_check_tsc at the thread's dispatch
  UncheckedRuns unchecked_runs;       // by the coordinator
  std::uint64_t asked_tsc = 0;        // when it was last asked how long the thread may run,
  HostDuration asked;                 // and how long
  // Under set costs (fixed_meter.h): the thread's charge at the last look at it; its CPU clock when
  // the thread was first found at that charge, or charged for its silence, -1: it has not been; and
  // the time until the next look at it.
  std::int64_t silent_cpu_ns = 0;
  std::int64_t silent_from_ns = -1;
  HostDuration next_look;
  bool pays_for_silence = false;  // the thread's client is known to compute for long without a call
  // On an ideal robot (ideal_meter.h): how many looks the thread has had in this dispatch; and
  // whether it has been found silent.
  int silent_looks = 0;
  bool is_silent = false;

  // The amount by which the page says that the thread's origin has moved. The amount may be
  // anything.
  std::int64_t OriginMovedOn(const shm::ClockPage& its) const {
    return static_cast<std::int64_t>(static_cast<std::uint64_t>(its.host_cpu_origin_ns) -
                                     static_cast<std::uint64_t>(page_origin_ns));
  }

  // The origin has been moved on here, not by the thread.
  void NoteOriginMoved(HostDuration by) {
    page_origin_ns += by.ns();
    host_origin_ns += by.ns();
  }
  // So much of what the thread has had by its CPU clock was the work of tcs, and is not charged.
  // Its page is written anew before the thread runs, or the thread itself has moved the origin
  // there.
  void NoteOwnWork(HostDuration by) {
    host_origin_ns += by.ns();
    own_work_in_all += by;
  }
  void NoteOwnWorkOnPage(HostDuration by) {
    page_origin_ns += by.ns();
    NoteOwnWork(by);
  }
  // As NoteOwnWork, of a thread whose page has been written. The thread is stopped.
  void Excuse(HostDuration by) {
    page->host_cpu_origin_ns += by.ns();
    NoteOwnWorkOnPage(by);
  }

  void TurnBegins() {
    own_work.TurnBegins();
    turn_cpu_ns = known_cpu_ns;
  }
  // The CPU clock is asked at the end of this turn, which is the thread's last.
  void AuditAtEnd() { unaudited_ticks = std::uint64_t{1} << 62; }

  bool has_origin() const { return host_origin_ns != kNoOrigin; }

  // Host time and virtual time are converted into each other here only.
  HostDuration OnHost(VirtualDuration computed) const {
    return HostNs(static_cast<std::int64_t>(static_cast<double>(computed.ns()) * speed));
  }
  VirtualDuration OnRobot(HostDuration computed) const {
    return VirtualNs(shm::MulQ32(computed.ns(), NsPerHostNsQ32()));
  }
  // The thread's charge in all once its CPU clock says `cpu_ns`.
  VirtualDuration ChargeAt(std::int64_t cpu_ns) const {
    return OnRobot(HostNs(cpu_ns - host_origin_ns));
  }
  // `ns` nanoseconds by the host's clock or by the robot's, by which the shim reckons: whichever
  // are longer.
  HostDuration OnEither(std::int64_t ns) const {
    return std::max(HostNs(ns), OnHost(VirtualNs(ns)));
  }
  // Virtual nanoseconds per one of the host's, times 2^32.
  std::uint64_t NsPerHostNsQ32() const { return static_cast<std::uint64_t>(4294967296.0 / speed); }
};

class Meter {
 public:
  // The thread's own CPU clock, in nanoseconds, by a system call; -1 if it cannot be read any more.
  using CpuClock = std::function<std::int64_t()>;

  // The costs of calls and allocations as the scenario says; none: as shm/set_costs.h has it.
  struct SetCosts {
    VirtualDuration call;
    std::optional<VirtualDuration> allocation;
  };

  enum class Found {
    kGoesOn,     // the thread may run on
    kAtHorizon,  // the thread has to stop
    kIsSilent,   // the thread computes on and on without a call, where computing takes no time
  };

  virtual ~Meter() = default;

  // Sets the fields of the grant by which the thread's clock runs in its next dispatch.
  virtual void SetRates(const MeteredThread& thread, const SetCosts& costs,
                        ClockGrant& grant) const = 0;

  // The thread is dispatched at `tsc`. `is_silent`: the thread was found silent when it last ran.
  // Returns the TSC at which its clock begins.
  virtual std::uint64_t Begin(MeteredThread& thread, std::uint64_t tsc, bool from_gate,
                              bool is_silent) = 0;

  // For how much real time from `tsc` on the thread need not be looked at.
  virtual HostDuration TimeToLook(MeteredThread& thread, std::uint64_t tsc,
                                  ProgramTime horizon) = 0;
  // The time of TimeToLook is over.
  virtual Found Look(MeteredThread& thread, std::uint64_t tsc, ProgramTime horizon,
                     const CpuClock& clock) = 0;

  // True if the coordinator has slept for so much longer than `asked` that what was stolen
  // meanwhile may be on all of the thread's clocks.
  virtual bool HasOverslept(std::uint64_t since_tsc, std::uint64_t tsc,
                            HostDuration asked) const = 0;
  // Then takes the stolen time out, and returns it. The thread's clock was at `before` when the
  // sleep began.
  virtual HostDuration TakeOutUnaccounted(MeteredThread& thread, const shm::ClockReading& before,
                                          std::uint64_t tsc, HostDuration asked,
                                          const CpuClock& clock) = 0;

  // Takes out of the thread's clock what was stolen until `tsc`, as its CPU clock tells.
  virtual void Check(MeteredThread& thread, std::uint64_t tsc, const CpuClock& clock) = 0;

  // The thread has stopped at `tsc`. After that the page says what its run has come to.
  virtual void End(MeteredThread& thread, std::uint64_t tsc, const CpuClock& clock) = 0;

  // The thread has made a system call that its shim knows nothing of.
  virtual void ChargeCall(MeteredThread& thread, VirtualDuration cost) = 0;
};

}  // namespace tcs
