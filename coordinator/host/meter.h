// A meter says what a thread's runs are charged: the time that they take (measured_meter.h), or set
// costs (fixed_meter.h). With that it knows for how long a thread may run before the coordinator
// looks at it again.
//
// The charge is on the thread's clock page, which the thread reads and moves, too
// (shm/clock_page.h); a meter touches it only while the thread is stopped. Times on the page are
// virtual and of the thread's process; horizons here are, too. A meter makes no system call: what
// the TSC and the thread's CPU clock say are arguments. It learns what switches and timers take on
// one processor of the host, so that each processor has a meter of its own. Not thread-safe.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <optional>

#include "coordinator/host/clock_grant.h"
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

// What a meter knows of one thread.
struct MeteredThread {
  shm::ClockPage* page = nullptr;
  double speed = 1.0;     // the host's nanoseconds per virtual one
  bool is_ideal = false;  // it is charged nothing (ideal_meter.h)
  // What the thread's CPU clock said when its charge was 0, moved by what is not charged, and by
  // what is without being computed.
  static constexpr std::int64_t kNoOrigin = INT64_MIN;  // not known yet
  std::int64_t host_origin_ns = kNoOrigin;
  std::int64_t page_origin_ns = 0;  // what its page says of that
  std::int64_t known_cpu_ns = -1;   // what it said last (shared_cpu_meter.h)
  HostDuration least_sleep;         // before it is looked at again (likewise)
  HostDuration longest_run = HostDuration::Milliseconds(10);  // of late
  // Others look at what it does in short steps: its CPU clock is asked after each turn.
  bool is_watched = false;
  // What its ways out of gates may still have taken: it says so itself, and it is not charged.
  HostDuration most_ways;
  std::uint64_t unchecked_ticks = 0;  // of TSC run since its CPU clock was last asked
  std::uint64_t unaudited_ticks = 0;  // the same, by the coordinator
  bool can_be_audited = true;         // in this turn: where it stops it stands still
  std::uint64_t checked_tsc = 0;      // what its page said of that at its dispatch
  UncheckedRuns unchecked_runs;       // by the coordinator
  std::uint64_t asked_tsc = 0;        // when it was last said how long it may run,
  HostDuration asked;                 // and how long
  // Under set costs (fixed_meter.h): what it had been charged when it was last looked at; what its
  // CPU clock said when it was first found there, or charged for it, -1: it has not been; and when
  // it is looked at next.
  std::int64_t silent_cpu_ns = 0;
  std::int64_t silent_from_ns = -1;
  HostDuration next_look;
  bool pays_for_silence = false;  // its client is known to compute for long without a call
  // On an ideal robot (ideal_meter.h): how many looks it has had in this dispatch; and whether it
  // has been found silent.
  int silent_looks = 0;
  bool is_silent = false;

  // What the page says that its origin has moved by, which may be anything.
  std::int64_t OriginMovedOn(const shm::ClockPage& its) const {
    return static_cast<std::int64_t>(static_cast<std::uint64_t>(its.host_cpu_origin_ns) -
                                     static_cast<std::uint64_t>(page_origin_ns));
  }

  // It is asked at the end of this turn, which is its last.
  void AuditAtEnd() { unaudited_ticks = std::uint64_t{1} << 62; }

  bool has_origin() const { return host_origin_ns != kNoOrigin; }

  // Host time and virtual time are made of each other here only.
  HostDuration OnHost(VirtualDuration computed) const {
    return HostNs(static_cast<std::int64_t>(static_cast<double>(computed.ns()) * speed));
  }
  VirtualDuration OnRobot(HostDuration computed) const {
    return VirtualNs(shm::MulQ32(computed.ns(), NsPerHostNsQ32()));
  }
  // What it is to be charged in all once its CPU clock says `cpu_ns`.
  VirtualDuration ChargeAt(std::int64_t cpu_ns) const {
    return OnRobot(HostNs(cpu_ns - host_origin_ns));
  }
  // So many nanoseconds by the host's clock or by the robot's, by which the shim reckons: whichever
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

  // What the scenario says that calls and allocations cost; none: as shm/set_costs.h has it.
  struct SetCosts {
    VirtualDuration call;
    std::optional<VirtualDuration> allocation;
  };

  enum class Found {
    kGoesOn,     // it may run on
    kAtHorizon,  // it has to stop
    kIsSilent,   // it computes on and on without a call, where computing takes no time
  };

  virtual ~Meter() = default;

  // By what the thread's clock runs in its next dispatch: sets those fields of the grant.
  virtual void SetRates(const MeteredThread& thread, const SetCosts& costs,
                        ClockGrant& grant) const = 0;

  // The thread is dispatched at `tsc`. `is_silent`: that is how it was found when it last ran.
  // Returns the TSC at which its clock begins.
  virtual std::uint64_t Begin(MeteredThread& thread, std::uint64_t tsc, bool from_gate,
                              bool is_silent) = 0;

  // For how much real time from `tsc` on the thread need not be looked at.
  virtual HostDuration TimeToLook(MeteredThread& thread, std::uint64_t tsc,
                                  ProgramTime horizon) = 0;
  // That is over.
  virtual Found Look(MeteredThread& thread, std::uint64_t tsc, ProgramTime horizon,
                     const CpuClock& clock) = 0;

  // True if the coordinator has slept for so much longer than `asked` that what was stolen
  // meanwhile may be on all of the thread's clocks.
  virtual bool HasOverslept(std::uint64_t since_tsc, std::uint64_t tsc,
                            HostDuration asked) const = 0;
  // Then takes it out, and returns it. The thread's clock was at `before` when the sleep began.
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
