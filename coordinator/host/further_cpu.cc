#include "coordinator/host/further_cpu.h"

#include <linux/futex.h>
#include <signal.h>
#include <sys/syscall.h>
#include <unistd.h>
#include <xmmintrin.h>

#include <algorithm>
#include <utility>

#include "coordinator/port/clocks.h"
#include "coordinator/port/levels.h"
#include "coordinator/port/proc_files.h"
#include "shm/time_values.h"

namespace tcs {

namespace {

constexpr std::int64_t kShortestSleepNs = 20'000, kLongestSleepNs = 1'000'000;
constexpr std::int64_t kLongestRestNs = 2'000'000;
constexpr std::int64_t kLeftToOthersNs = 500'000'000;
constexpr int kMostDoublings = 6;
constexpr std::int64_t kWayToSleepNs = 20'000, kMostWayHomeNs = 2'000'000;
constexpr std::int64_t kMostLookNs = 200'000;
constexpr std::int64_t kClaimsEveryNs = 100'000'000;
constexpr std::int64_t kForEverNs = 3'600'000'000'000;

}  // namespace

FurtherCpu::FurtherCpu(int cpu, int home, double ticks_per_ns, Executor& executor,
                       std::function<bool(int)> is_claimed)
    : cpu_(cpu),
      home_(home),
      ticks_per_ns_(ticks_per_ns),
      executor_(executor),
      asks_whether_claimed_(std::move(is_claimed)) {}

FurtherCpu::~FurtherCpu() {
  ends_.store(true);
  WakeWarden();
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

void FurtherCpu::WakeWarden() {
  ++wakes_;
  syscall(SYS_futex, &wakes_, FUTEX_WAKE_PRIVATE, 1, nullptr, nullptr, 0);
}

// --- The warden
// -----------------------------------------------------------------------------------

void FurtherCpu::Guard() {
  BindTo(0, cpu_);
  while (!ends_.load()) {
    const std::uint32_t wakes = wakes_.load();
    Fetch();
    Sleep(wakes, NsToGuard());
  }
}

// Sleeps until the warden is woken again, after `wakes` times, or `ns` have passed.
void FurtherCpu::Sleep(std::uint32_t wakes, std::int64_t ns) {
  const timespec timeout = shm::ToTimespec(ns);
  syscall(SYS_futex, &wakes_, FUTEX_WAIT_PRIVATE, wakes, &timeout, nullptr, 0);
}

// In this order: with ordinary priority on the home processor the thread could run there, before
// the coordinator, for as long as the kernel has ordinary threads run that real-time ones have kept
// waiting (50 ms of each second).
void FurtherCpu::Fetch() {
  Place asked = Place::kAsked;
  if (!place_.compare_exchange_strong(asked, Place::kMoves)) return;
  const bool may_come = allowed_ns_.load() > 0;
  if (may_come && BindTo(tid_, cpu_)) {
    executor_.LetGo(tid_);
    place_.store(Place::kHere);
    return;
  }
  is_refused_.store(may_come && ReadComputed() >= 0);
  Leave();
}

void FurtherCpu::Leave() {
  left_at_ns_ = PassedNs(HostTsc());
  place_.store(Place::kLeft);
}

// Sends the thread home that has come to its limit and is not allowed on soon. Returns for how long
// no thread has to be looked after.
std::int64_t FurtherCpu::NsToGuard() {
  looks_.store(true);
  std::int64_t left_ns = place_.load() == Place::kHere ? LeftAfterLook() : kForEverNs;
  if (left_ns <= 0 && may_rest_.load() && !is_claimed_.load()) left_ns = LeftAfterRest();
  looks_.store(false);
  if (left_ns == kForEverNs) return left_ns;
  if (left_ns > 0) return std::clamp(left_ns, kShortestSleepNs, kLongestSleepNs);
  Place here = Place::kHere;
  if (place_.compare_exchange_strong(here, Place::kMoves)) {
    executor_.Hold(tid_);
    BindTo(tid_, home_);
    Leave();
  }
  return kForEverNs;
}

// The thread does not run meanwhile, so that its CPU clock is right.
std::int64_t FurtherCpu::LeftAfterLook() {
  const std::uint64_t tsc = HostTsc();
  const std::int64_t computed_ns = std::max<std::int64_t>(0, ReadComputed());
  ahead_.Know(PassedNs(tsc), computed_ns);
  ++looked_;
  return IsClaimedBy(tsc) ? 0 : allowed_ns_.load() - computed_ns;
}

// The thread does not compute while the warden looks whether it may. Another limit ends that, and
// so does the coordinator where it takes the thread home: to do so, the coordinator waits until the
// warden does not look any more.
std::int64_t FurtherCpu::LeftAfterRest() {
  const std::uint64_t until_tsc = HostTsc() + TicksIn(kLongestRestNs);
  const std::int64_t limit_ns = allowed_ns_.load();
  if (limit_ns <= 0) return 0;  // the thread is wanted at home
  ahead_.Rest();
  while (allowed_ns_.load() == limit_ns && may_rest_.load() && !ends_.load() &&
         place_.load() == Place::kHere && HostTsc() < until_tsc) {
    _mm_pause();
  }
  ahead_.GoOn(PassedNs(HostTsc()));
  return place_.load() == Place::kHere ? LeftAfterLook() : kForEverNs;
}

// Other runs come and go.
bool FurtherCpu::IsClaimedBy(std::uint64_t tsc) {
  if (tsc >= looks_for_claims_tsc_) {
    looks_for_claims_tsc_ = tsc + TicksIn(kClaimsEveryNs);
    is_claimed_.store(asks_whether_claimed_(cpu_));
  }
  return is_claimed_.load();
}

// --- Of both
// --------------------------------------------------------------------------------------

std::uint64_t FurtherCpu::TicksIn(std::int64_t ns) const {
  return static_cast<std::uint64_t>(static_cast<double>(ns) * ticks_per_ns_);
}

std::int64_t FurtherCpu::PassedNs(std::uint64_t tsc) const {
  return static_cast<std::int64_t>(static_cast<double>(tsc - since_tsc_) / ticks_per_ns_);
}

// The time computed since the thread was sent; negative: the thread has ended.
std::int64_t FurtherCpu::ReadComputed() const {
  return ReadThreadCpuClock(clock_.get()) - begun_ns_;
}

// --- The coordinator
// ------------------------------------------------------------------------------

bool FurtherCpu::Send(HostThread& thread, std::uint64_t tsc, std::int64_t allowed_ns) {
  UniqueFd clock(OpenThreadCpuClock(thread.tid));
  const std::int64_t begun_ns = clock ? ReadThreadCpuClock(clock.get()) : -1;
  if (begun_ns < 0) return false;
  if (!warden_.joinable()) StartWarden();
  // The thread does not run where it is until it is fetched.
  if (std::exchange(thread.may_run, false)) executor_.Hold(thread.tid);
  thread_ = &thread;
  thread.is_ahead = true;
  tid_ = thread.tid;
  since_tsc_ = tsc;
  clock_ = std::move(clock);
  begun_ns_ = begun_ns;
  ahead_.Start();
  allowed_ns_.store(allowed_ns);
  place_.store(Place::kAsked);
  WakeWarden();
  return true;
}

std::int64_t FurtherCpu::Computed() const {
  return HasLeft() ? std::max<std::int64_t>(0, ReadComputed()) : ahead_.computed_ns();
}

std::int64_t FurtherCpu::MayHaveComputedBy(std::uint64_t tsc) const {
  return HasLeft() ? Computed() : ahead_.MayHaveComputedBy(PassedNs(tsc), allowed_ns_.load());
}

bool FurtherCpu::HaveLooked() {
  const std::uint32_t looked = looked_.load();
  WakeWarden();
  const std::uint64_t until_tsc = HostTsc() + TicksIn(kMostLookNs);
  while (looked_.load() == looked) {
    if (Rests() || HasLeft()) return true;  // then the computed time is known
    if (HostTsc() >= until_tsc) return false;
    _mm_pause();
  }
  return true;
}

bool FurtherCpu::IsStarvedBy(std::uint64_t tsc) {
  // After the thread has left, the warden does not look any more, however late this process comes
  // to ask.
  return is_claimed_.load() || ahead_.IsStarvedBy(HasLeft() ? left_at_ns_ : PassedNs(tsc));
}

// A thread that has spoken is on its way to sleep. A thread that computes on is sent home by the
// warden: the kernel would have this process sleep until a thread that runs elsewhere has stopped,
// and threads would run meanwhile whose turn it is not.
void FurtherCpu::AwaitStandstill() const {
  const std::uint64_t sleeps_by_tsc = HostTsc() + TicksIn(kWayToSleepNs);
  while (ThreadState(tid_) == 'R' && HostTsc() < sleeps_by_tsc) _mm_pause();
}

void FurtherCpu::HaveSentHome() {
  allowed_ns_.store(0);
  WakeWarden();
  const std::uint64_t until_tsc = HostTsc() + TicksIn(kMostWayHomeNs);
  while (!HasLeft() && HostTsc() < until_tsc) _mm_pause();
}

// The warden acts on a thread only as long as the thread is the warden's: it has looked away before
// the coordinator goes on.
void FurtherCpu::TakeBack() {
  Place place = place_.load();
  while (place != Place::kLeft) {
    const bool is_moving = place == Place::kMoves;
    if (!is_moving && place_.compare_exchange_strong(place, Place::kHome)) break;
    _mm_pause();
    place = place_.load();
  }
  while (looks_.load()) _mm_pause();
  if (place == Place::kHere) {
    executor_.Hold(tid_);
    BindTo(tid_, home_);
  }
  place_.store(Place::kHome);
}

void FurtherCpu::BringHome() {
  if (!HasLeft()) AwaitStandstill();
  if (!HasLeft() && ThreadState(tid_) == 'R') HaveSentHome();
  TakeBack();
  thread_->is_ahead = false;
  thread_ = nullptr;
  if (is_refused_.load()) not_before_tsc_ = UINT64_MAX;
  if (is_claimed_.exchange(false)) LeaveToOthers(HostTsc());
}

void FurtherCpu::LeaveToOthers(std::uint64_t tsc) {
  // The count begins anew for a processor that was of use for longer than it had been left to
  // others.
  if (tsc > not_before_tsc_ + left_ticks_) left_to_others_ = 0;
  left_ticks_ = TicksIn(kLeftToOthersNs << std::min(left_to_others_++, kMostDoublings));
  not_before_tsc_ = tsc + left_ticks_;
}

}  // namespace tcs
