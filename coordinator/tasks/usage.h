// The usage of a thread, a process, or a client with all that it has started, for the report.
#pragma once

#include <cstdint>

#include "shm/time_kinds.h"
#include "shm/work_counts.h"

namespace tcs {

// Answers that were waited for from outside of the run (calls/outside_waits.h).
struct OutsideUsage {
  std::int64_t answers = 0;
  VirtualDuration waited;
};

struct Usage {
  std::int64_t charged_ns = 0;   // virtual
  std::int64_t priced_ns = 0;    // of that: work of which tcs spares programs (price_list.h)
  std::int64_t host_cpu_ns = 0;  // by the kernel's CPU clocks, less own_work_ns
  std::int64_t own_work_ns = 0;  // the work of tcs: the shim's, and the ways to the coordinator
  std::int64_t stolen_ns = 0;
  std::int64_t activations = 0, overruns = 0;
  shm::WorkCounts work{};  // where it is counted

  Usage& operator+=(const Usage& more) {
    charged_ns += more.charged_ns;
    priced_ns += more.priced_ns;
    host_cpu_ns += more.host_cpu_ns;
    own_work_ns += more.own_work_ns;
    stolen_ns += more.stolen_ns;
    activations += more.activations;
    overruns += more.overruns;
    work.calls += more.work.calls;
    work.locks += more.work.locks;
    return *this;
  }
};

// Of a process's threads that have ended. The CPU clock of a thread that was killed with its
// process cannot be read any more; but the process's clock, which can be read until somebody reaps
// the process, has what all threads had. Pure.
class EndedThreads {
 public:
  // `usage` without host_cpu_ns. `clock_ns` is what the thread's CPU clock shows, negative if that
  // cannot be read; the thread was first charged at `origin_ns` of that clock, and is to have had
  // `fallback_ns` where nobody can tell.
  void Add(const Usage& usage, std::int64_t clock_ns, std::int64_t origin_ns,
           std::int64_t fallback_ns) {
    usage_ += usage;
    if (clock_ns < 0) {
      usage_.host_cpu_ns += fallback_ns;
      lost_origins_ns_ += origin_ns;
      lost_fallback_ns_ += fallback_ns;
      has_lost_ = true;
    } else {
      usage_.host_cpu_ns += clock_ns - origin_ns;
      clocks_ns_ += clock_ns;
    }
  }

  // All threads have ended; the process's clock shows `process_clock_ns`.
  void Complete(std::int64_t process_clock_ns) {
    if (!has_lost_ || threads_changed_clocks_ || process_clock_ns < clocks_ns_) return;
    usage_.host_cpu_ns += process_clock_ns - clocks_ns_ - lost_origins_ns_ - lost_fallback_ns_;
    has_lost_ = false;
  }

  // A thread has become the first one, as in an exec, and its clock the first thread's.
  void NoteChangedClocks() { threads_changed_clocks_ = true; }
  void CountOverruns(std::int64_t overruns) { usage_.overruns += overruns; }

  const Usage& usage() const { return usage_; }

 private:
  Usage usage_;
  std::int64_t clocks_ns_ = 0, lost_origins_ns_ = 0, lost_fallback_ns_ = 0;
  bool has_lost_ = false, threads_changed_clocks_ = false;
};

}  // namespace tcs
