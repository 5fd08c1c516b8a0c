// A further processor of the host, beside the one on which the threads of a run take turns. A
// thread that computes can be sent there, to compute ahead of its turns: when its turn comes it has
// computed already what it would have to compute then. As soon as it makes a call, or looks at its
// clock, it waits at its gate. So nothing that it does is seen before its turn, but in memory that
// it shares with others.
//
// It may compute as far as it is allowed to. A warden sees to that, a thread of this process on
// that processor, before which it goes: it looks what the thread has computed, sleeps for as long
// as that one may go on, and sends it home when it has come to its limit, however late this
// process's other thread looks. The thread itself has ordinary priority there: it takes the
// processor from nobody, and when somebody dies it leaves no real-time thread.
//
// Send, Allow and the others are for the coordinator's thread only.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <thread>

#include "coordinator/host/ahead_clock.h"
#include "coordinator/host/executor.h"
#include "coordinator/host/host_thread.h"
#include "coordinator/os/unique_fd.h"

namespace tcs {

class FurtherCpu {
 public:
  // Threads come from and go back to the processor `home`. `is_claimed`: whether another run has
  // claimed the processor of that number; any thread may ask.
  FurtherCpu(int cpu, int home, double ticks_per_ns, Executor& executor,
             std::function<bool(int)> is_claimed);
  ~FurtherCpu();
  FurtherCpu(const FurtherCpu&) = delete;
  FurtherCpu& operator=(const FurtherCpu&) = delete;

  int cpu() const { return cpu_; }
  // The thread that is here, or has been sent home since and is still said to be here; or null.
  HostThread* thread() const { return thread_; }
  // Others need the processor: nobody is to be sent here before `tsc`.
  bool IsFreeAt(std::uint64_t tsc) const { return thread_ == nullptr && tsc >= not_before_tsc_; }

  // The thread, which has stopped, computes on here, for as long as its CPU clock counts
  // `allowed_ns` from now on. False if the kernel does not let it.
  bool Send(HostThread& thread, std::uint64_t tsc, std::int64_t allowed_ns);
  // In all, since it was sent.
  void Allow(std::int64_t allowed_ns) { allowed_ns_.store(allowed_ns); }
  // What it has computed by then since it was sent (ahead_clock.h).
  std::int64_t ComputedBy(std::uint64_t tsc);
  // Others had the processor for long, by then, or have claimed it.
  bool IsStarvedBy(std::uint64_t tsc);
  // It has come to its limit, and is at home.
  bool HasLeft() const { return has_left_.load(); }

  // It stands still at home, if it lives, and is not said to be here any more. Where it computed,
  // this process looks on until it has stopped, and does not sleep.
  void BringHome();
  // Others had the processor for long: nobody comes here for some time, and for twice as long if
  // they had it again within as long as it was left to them before.
  void LeaveToOthers(std::uint64_t tsc);

 private:
  std::unique_lock<std::mutex> Lock();
  void AwaitStandstill() const;
  void HaveSentHome();
  void StartWarden();
  void Guard();
  std::uint64_t TicksIn(std::int64_t ns) const;
  std::int64_t PassedNs(std::uint64_t tsc) const;
  std::int64_t Computed() const;
  void Look(std::uint64_t tsc);
  void LookForClaims(std::uint64_t tsc);

  const int cpu_, home_;
  const double ticks_per_ns_;
  Executor& executor_;
  const std::function<bool(int)> asks_whether_claimed_;
  HostThread* thread_ = nullptr;
  int left_to_others_ = 0;        // in a row
  std::uint64_t left_ticks_ = 0;  // the last time
  std::uint64_t not_before_tsc_ = 0;
  std::atomic<std::int64_t> allowed_ns_{0};
  std::atomic<bool> has_left_{false};
  std::atomic<bool> is_claimed_{false};  // another run was found to take its turns here

  std::mutex mutex_;  // of what follows
  std::condition_variable changed_;
  pid_t tid_ = 0;  // whom the warden looks after; 0: nobody
  std::uint64_t since_tsc_ = 0;
  std::uint64_t looks_for_claims_tsc_ = 0;
  UniqueFd clock_;  // its CPU clock,
  std::int64_t begun_ns_ = 0;
  AheadClock ahead_;
  std::int64_t left_at_ns_ = 0;  // when it left, since it was sent
  bool ends_ = false;
  std::thread warden_;
};

}  // namespace tcs
