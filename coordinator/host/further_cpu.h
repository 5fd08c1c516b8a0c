// A further processor of the host, beside the one on which the threads of a run take turns. A
// thread that computes can be sent there, to compute ahead of its turns: when its turn comes it has
// computed already what it would have to compute then. As soon as the thread makes a call, or looks
// at its clock, it waits at its gate. So nothing that the thread does is seen before its turn, but
// in memory that it shares with others.
//
// The thread may compute as far as it is allowed to. The warden sees to that: a thread of this
// process on that processor, which goes before the computing thread. The warden fetches the thread,
// looks what the thread has computed, and sleeps for as long as the thread may go on. When the
// thread has come to its limit, the warden keeps it from computing. At first the warden does so by
// looking on itself, for as long as the limit may be raised at any moment, because to send a thread
// home and fetch it again costs both processors more than that. Then the warden sends the thread
// home. The kernel may let the coordinator stand at any place, for 50 ms of each second (real-time
// throttling). So the warden never waits for the coordinator, and a thread that the coordinator has
// asked the warden to fetch is either held at home or guarded. The computing thread has ordinary
// priority here: it takes the processor from no other thread, and when a process dies it leaves no
// real-time thread.
//
// Send, Allow and the others are for the coordinator's thread only.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <thread>

#include "coordinator/host/ahead_clock.h"
#include "coordinator/host/executor.h"
#include "coordinator/host/host_thread.h"
#include "coordinator/port/unique_fd.h"

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
  // False while a thread is here, and while others need the processor: no thread is to be sent here
  // at `tsc`.
  bool IsFreeAt(std::uint64_t tsc) const { return thread_ == nullptr && tsc >= not_before_tsc_; }

  // The thread, which has stopped, is fetched to compute on here, for as long as its CPU clock
  // counts `allowed_ns` from now on. False if the thread has ended. If the kernel does not let the
  // thread come here, the thread has left at once, and no thread is sent here any more.
  bool Send(HostThread& thread, std::uint64_t tsc, std::int64_t allowed_ns);
  // The time that the thread may compute in all, since it was sent.
  void Allow(std::int64_t allowed_ns) { allowed_ns_.store(allowed_ns); }
  // A thread that comes to the limit goes home at once from now on: while one thread rests here no
  // other gets the processor.
  void LetNobodyRest() { may_rest_.store(false); }
  // The time that the thread has computed since it was sent, as far as that is certain; and the
  // time that it has computed by `tsc` if no other thread took the processor from it
  // (ahead_clock.h).
  std::int64_t Computed() const;
  std::int64_t MayHaveComputedBy(std::uint64_t tsc) const;
  // Has the warden look what the thread has computed, and waits for that; not for long, for the
  // kernel may hold the warden: then false. The thread is kept from computing for some us.
  bool HaveLooked();
  // True if others have had the processor for long by then, or have claimed it.
  bool IsStarvedBy(std::uint64_t tsc);
  // The thread has come to its limit, and computes on here as soon as it is allowed to.
  bool Rests() const { return ahead_.rests(); }
  // The thread has come to its limit, and is at home.
  bool HasLeft() const { return place_.load() == Place::kLeft; }

  // The thread stands still at home, if it lives, and is not said to be here any more. Where the
  // thread computed, this process busy-waits until the thread has stopped: it does not sleep.
  void BringHome();
  // Other threads had the processor for long: no thread comes here for some time. That time is
  // twice as long if they had the processor again within as long as it was left to them before.
  void LeaveToOthers(std::uint64_t tsc);

 private:
  // The place of the thread. The place also says who may touch the thread and what is known of it:
  // the coordinator where the thread is at home or has left, else the warden.
  enum class Place : int {
    kHome,   // or there is none
    kAsked,  // the warden is asked to fetch the thread; the coordinator may take that back
    kMoves,  // the warden moves the thread, one way or the other
    kHere,   // the warden looks after the thread; the coordinator may take it home
    kLeft,   // the warden has sent the thread home
  };

  void AwaitStandstill() const;
  void HaveSentHome();
  void TakeBack();
  void StartWarden();
  void WakeWarden();
  void Guard();
  void Fetch();
  void Leave();
  std::int64_t NsToGuard();
  std::int64_t LeftAfterLook();
  std::int64_t LeftAfterRest();
  void Sleep(std::uint32_t wakes, std::int64_t ns);
  std::uint64_t TicksIn(std::int64_t ns) const;
  std::int64_t PassedNs(std::uint64_t tsc) const;
  std::int64_t ReadComputed() const;
  bool IsClaimedBy(std::uint64_t tsc);

  const int cpu_, home_;
  const double ticks_per_ns_;
  Executor& executor_;
  const std::function<bool(int)> asks_whether_claimed_;
  HostThread* thread_ = nullptr;
  int left_to_others_ = 0;        // in a row
  std::uint64_t left_ticks_ = 0;  // the last time
  std::uint64_t not_before_tsc_ = 0;

  std::atomic<Place> place_{Place::kHome};
  std::atomic<bool> looks_{false};  // the warden looks at what is known of the thread
  std::atomic<std::uint32_t> looked_{0};
  std::atomic<std::uint32_t> wakes_{0};
  std::atomic<bool> ends_{false};
  std::atomic<std::int64_t> allowed_ns_{0};
  std::atomic<bool> may_rest_{true};
  std::atomic<bool> is_claimed_{false};  // another run was found to take its turns here
  std::atomic<bool> is_refused_{false};  // by the kernel

  pid_t tid_ = 0;
  std::uint64_t since_tsc_ = 0;
  std::uint64_t looks_for_claims_tsc_ = 0;
  UniqueFd clock_;  // the thread's CPU clock
  std::int64_t begun_ns_ = 0;
  AheadClock ahead_;
  std::int64_t left_at_ns_ = 0;  // when the thread left, since it was sent
  std::thread warden_;
};

}  // namespace tcs
