#include "coordinator/host/further_cpu.h"

#include <signal.h>
#include <x86gprintrin.h>
#include <xmmintrin.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "coordinator/os/host.h"

namespace tcs {

namespace {

constexpr std::int64_t kShortestSleepNs = 20'000, kLongestSleepNs = 1'000'000;
constexpr std::int64_t kLeftToOthersNs = 500'000'000;
constexpr int kMostDoublings = 6;
constexpr std::int64_t kWayToSleepNs = 20'000, kMostWayHomeNs = 2'000'000;
constexpr std::int64_t kClaimsEveryNs = 100'000'000;

}  // namespace

FurtherCpu::FurtherCpu(int cpu, int home, double ticks_per_ns, Executor& executor,
                       std::function<bool(int)> is_claimed)
    : cpu_(cpu),
      home_(home),
      ticks_per_ns_(ticks_per_ns),
      executor_(executor),
      asks_whether_claimed_(std::move(is_claimed)) {}

FurtherCpu::~FurtherCpu() {
  {
    const std::lock_guard lock(mutex_);
    ends_ = true;
  }
  changed_.notify_one();
  if (warden_.joinable()) warden_.join();
}

// Signals of the run are for its own thread.
void FurtherCpu::StartWarden() {
  sigset_t all, before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  warden_ = std::thread([this] { Guard(); });
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

void FurtherCpu::Guard() {
  BindTo(0, cpu_);
  std::unique_lock lock(mutex_);
  while (!ends_) {
    if (tid_ == 0) {
      changed_.wait(lock);
      continue;
    }
    Look(__rdtsc());
    LookForClaims(__rdtsc());
    const std::int64_t left_ns = allowed_ns_.load() - Computed();
    if (left_ns > 0 && !is_claimed_.load()) {
      changed_.wait_for(
          lock, std::chrono::nanoseconds(std::clamp(left_ns, kShortestSleepNs, kLongestSleepNs)));
      continue;
    }
    executor_.Hold(tid_);
    BindTo(tid_, home_);
    tid_ = 0;
    left_at_ns_ = PassedNs(__rdtsc());
    has_left_.store(true);
  }
}

std::uint64_t FurtherCpu::TicksIn(std::int64_t ns) const {
  return static_cast<std::uint64_t>(static_cast<double>(ns) * ticks_per_ns_);
}

std::int64_t FurtherCpu::PassedNs(std::uint64_t tsc) const {
  return static_cast<std::int64_t>(static_cast<double>(tsc - since_tsc_) / ticks_per_ns_);
}

std::int64_t FurtherCpu::Computed() const {
  return std::max<std::int64_t>(0, ReadThreadCpuClock(clock_.get()) - begun_ns_);
}

// The thread does not run meanwhile, so that its CPU clock is right.
void FurtherCpu::Look(std::uint64_t tsc) { ahead_.Know(PassedNs(tsc), Computed()); }

// Other runs come and go.
void FurtherCpu::LookForClaims(std::uint64_t tsc) {
  if (tsc < looks_for_claims_tsc_) return;
  looks_for_claims_tsc_ = tsc + TicksIn(kClaimsEveryNs);
  is_claimed_.store(asks_whether_claimed_(cpu_));
}

bool FurtherCpu::Send(HostThread& thread, std::uint64_t tsc, std::int64_t allowed_ns) {
  UniqueFd clock(OpenThreadCpuClock(thread.tid));
  const std::int64_t begun_ns = clock ? ReadThreadCpuClock(clock.get()) : -1;
  if (begun_ns < 0) return false;
  if (!warden_.joinable()) StartWarden();
  // In this order: with ordinary priority on the home processor it could run there, before this
  // process, for as long as the kernel has ordinary threads run that real-time ones have kept
  // waiting (50 ms of each second).
  if (!BindTo(thread.tid, cpu_)) {
    not_before_tsc_ = UINT64_MAX;
    return false;
  }
  executor_.LetGo(thread.tid);
  thread_ = &thread;
  thread.is_ahead = true;
  thread.may_run = false;
  allowed_ns_.store(allowed_ns);
  has_left_.store(false);
  {
    const auto lock = Lock();
    tid_ = thread.tid;
    since_tsc_ = tsc;
    clock_ = std::move(clock);
    begun_ns_ = begun_ns;
    ahead_ = {};
  }
  changed_.notify_one();
  return true;
}

std::int64_t FurtherCpu::ComputedBy(std::uint64_t tsc) {
  const auto lock = Lock();
  return has_left_.load() ? Computed() : ahead_.ComputedBy(PassedNs(tsc), allowed_ns_.load());
}

bool FurtherCpu::IsStarvedBy(std::uint64_t tsc) {
  const auto lock = Lock();
  // Since it has left nobody looks, however late this process comes to ask.
  return is_claimed_.load() || ahead_.IsStarvedBy(has_left_.load() ? left_at_ns_ : PassedNs(tsc));
}

// If this process slept meanwhile, threads would run whose turn it is not.
std::unique_lock<std::mutex> FurtherCpu::Lock() {
  std::unique_lock lock(mutex_, std::defer_lock);
  while (!lock.try_lock()) _mm_pause();
  return lock;
}

// One that has spoken is on its way to sleep. One that computes on is sent home by the warden: the
// kernel would have this process sleep until a thread that runs elsewhere has stopped.
void FurtherCpu::AwaitStandstill() const {
  const pid_t tid = thread_->tid;
  const std::uint64_t sleeps_by_tsc = __rdtsc() + TicksIn(kWayToSleepNs);
  while (ThreadState(tid) == 'R' && __rdtsc() < sleeps_by_tsc) _mm_pause();
}

void FurtherCpu::HaveSentHome() {
  allowed_ns_.store(0);
  changed_.notify_one();
  const std::uint64_t until_tsc = __rdtsc() + TicksIn(kMostWayHomeNs);
  while (!has_left_.load() && __rdtsc() < until_tsc) _mm_pause();
}

void FurtherCpu::BringHome() {
  if (!has_left_.load()) AwaitStandstill();
  if (!has_left_.load() && ThreadState(thread_->tid) == 'R') HaveSentHome();
  const auto lock = Lock();
  if (tid_ != 0) {
    executor_.Hold(tid_);
    BindTo(tid_, home_);
  }
  tid_ = 0;
  thread_->is_ahead = false;
  thread_ = nullptr;
  if (is_claimed_.exchange(false)) LeaveToOthers(__rdtsc());
}

void FurtherCpu::LeaveToOthers(std::uint64_t tsc) {
  // What was of use for longer than it had been left to others begins anew.
  if (tsc > not_before_tsc_ + left_ticks_) left_to_others_ = 0;
  left_ticks_ = TicksIn(kLeftToOthersNs << std::min(left_to_others_++, kMostDoublings));
  not_before_tsc_ = tsc + left_ticks_;
}

}  // namespace tcs
