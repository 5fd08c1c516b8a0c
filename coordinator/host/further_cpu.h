// A further processor of the host, beside the one on which the threads of a run take turns. A
// thread that computes can be sent there, to compute ahead of its turns: when its turn comes it has
// computed already what it would have to compute then. As soon as it makes a call, or looks at its
// clock, it waits at its gate. So nothing that it does is seen before its turn, but in memory that
// it shares with others.
//
// It may compute as far as it is allowed to. A warden sees to that, a thread of this process on
// that processor, before which it goes: it fetches the thread, looks what it has computed, sleeps
// for as long as that one may go on, and keeps it from computing when it has come to its limit: by
// looking on itself, for as long as the limit may be raised at any moment, because to send a thread
// home and fetch it again costs both processors more than that; then it sends it home. The kernel
// may let the coordinator stand at any place, for 50 ms of each second (real-time throttling). So
// the warden never waits for it, and whom the coordinator has asked it to fetch is either held at
// home or guarded. The thread itself has ordinary priority here: it takes the processor from
// nobody, and when somebody dies it leaves no real-time thread.
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
  // Others need the processor: nobody is to be sent here before `tsc`.
  bool IsFreeAt(std::uint64_t tsc) const { return thread_ == nullptr && tsc >= not_before_tsc_; }

  // The thread, which has stopped, is fetched to compute on here, for as long as its CPU clock
  // counts `allowed_ns` from now on. False if it has ended. If the kernel does not let it come here
  // it has left at once, and nobody is sent here any more.
  bool Send(HostThread& thread, std::uint64_t tsc, std::int64_t allowed_ns);
  // In all, since it was sent.
  void Allow(std::int64_t allowed_ns) { allowed_ns_.store(allowed_ns); }
  // Whoever comes to the limit goes home at once from now on: while one rests here nobody else gets
  // the processor.
  void LetNobodyRest() { may_rest_.store(false); }
  // What it has computed since it was sent, as far as that is certain; and what it has computed by
  // then if nobody took the processor from it (ahead_clock.h).
  std::int64_t Computed() const;
  std::int64_t MayHaveComputedBy(std::uint64_t tsc) const;
  // Has the warden look what it has computed, and waits for that; not for long, for the kernel may
  // hold the warden: then false. The thread is kept from computing for some us.
  bool HaveLooked();
  // Others had the processor for long, by then, or have claimed it.
  bool IsStarvedBy(std::uint64_t tsc);
  // It has come to its limit, and computes on here as soon as it is allowed to.
  bool Rests() const { return ahead_.rests(); }
  // It has come to its limit, and is at home.
  bool HasLeft() const { return place_.load() == Place::kLeft; }

  // It stands still at home, if it lives, and is not said to be here any more. Where it computed,
  // this process looks on until it has stopped, and does not sleep.
  void BringHome();
  // Others had the processor for long: nobody comes here for some time, and for twice as long if
  // they had it again within as long as it was left to them before.
  void LeaveToOthers(std::uint64_t tsc);

 private:
  // Of the thread, and with it who may touch it and what is known of it: the coordinator where it
  // is at home or has left, else the warden.
  enum class Place : int {
    kHome,   // or there is none
    kAsked,  // the warden is asked to fetch it; the coordinator may take that back
    kMoves,  // the warden moves it, one way or the other
    kHere,   // the warden looks after it; the coordinator may take it home
    kLeft,   // the warden has sent it home
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
  std::atomic<bool> looks_{false};  // the warden, at what is known of the thread
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
  UniqueFd clock_;  // its CPU clock,
  std::int64_t begun_ns_ = 0;
  AheadClock ahead_;
  std::int64_t left_at_ns_ = 0;  // when it left, since it was sent
  std::thread warden_;
};

}  // namespace tcs
