#include "coordinator/host/beside_cpu.h"

#include <linux/futex.h>
#include <signal.h>
#include <sys/syscall.h>
#include <unistd.h>
#include <xmmintrin.h>

#include <algorithm>
#include <utility>

#include "coordinator/host/host_cpu.h"
#include "coordinator/port/clocks.h"
#include "coordinator/port/levels.h"
#include "coordinator/port/proc_files.h"

namespace tcs {

namespace {

using shm::Saying;

constexpr std::int64_t kAwakeNs = 2'000'000;  // after a turn has begun
constexpr std::int64_t kBusyNs = 3'000'000;
constexpr std::int64_t kMostWayBackNs = 2'000'000;
constexpr std::int64_t kClaimsBesideEveryNs = 100'000'000;
constexpr std::int64_t kLeftBesideNs = 2'000'000;
constexpr int kMostDoublingsBeside = 8;
constexpr std::uint32_t kNobody = UINT32_MAX;  // to be sent home: the warden ends
constexpr std::uint32_t kSends = 1u << 31;
// The opener may take so long before the coordinator helps it, by a system call.
constexpr std::int64_t kMostOpenNs = 100'000;

}  // namespace

BesideCpu::BesideCpu(int cpu, int home, double ticks_per_ns, Executor& executor,
                     std::function<bool(int)> is_claimed)
    : cpu_(cpu),
      home_(home),
      ticks_per_ns_(ticks_per_ns),
      executor_(executor),
      is_claimed_(std::move(is_claimed)) {}

BesideCpu::~BesideCpu() {
  ends_.store(true);
  awake_until_tsc_.store(0);
  // Other values than those at which the opener and the warden are about to sleep, perhaps.
  sleeps_.store(0);
  sends_.store(kNobody);
  Wake(sleeps_);
  Wake(sends_);
  if (opener_.joinable()) opener_.join();
  if (warden_.joinable()) warden_.join();
}

std::uint64_t BesideCpu::TicksIn(std::int64_t ns) const {
  return static_cast<std::uint64_t>(static_cast<double>(ns) * ticks_per_ns_);
}

void BesideCpu::Wake(std::atomic<std::uint32_t>& word) {
  syscall(SYS_futex, &word, FUTEX_WAKE_PRIVATE, 1, nullptr, nullptr, 0);
}

// --- The two threads here
// -------------------------------------------------------------------------

// Signals of the run are for its own thread.
void BesideCpu::Start() {
  sigset_t all, before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  opener_ = std::thread([this] { OpenGates(); });
  warden_ = std::thread([this] { SendHomeWhenAsked(); });
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

void BesideCpu::OpenGates() {
  // In this order: at home, with any lower priority, the opener would wait for long to get here.
  BindTo(0, cpu_);
  LeaveRealTime(0);
  RunOnlyWhenIdle();
  opener_tid_.store(gettid());
  while (!ends_.load()) {
    while (OpenNext() || HostTsc() < awake_until_tsc_.load(std::memory_order_relaxed)) _mm_pause();
    sleeps_.store(1);
    if (asked_.load() != opened_) continue;
    if (ends_.load()) return;
    syscall(SYS_futex, &sleeps_, FUTEX_WAIT_PRIVATE, 1, nullptr, nullptr, 0);
  }
}

// The thread runs instead of the opener, and the opener runs again once the thread has stopped.
bool BesideCpu::OpenNext() {
  if (asked_.load(std::memory_order_acquire) == opened_) return false;
  opens_.store(true);
  shm::ThreadSlot* slot = gates_[opened_++ % kMostGates].exchange(nullptr);
  if (slot != nullptr) HostCpu::OpenGate(*slot);
  opens_.store(false);
  return true;
}

void BesideCpu::SendHomeWhenAsked() {
  BindTo(0, cpu_);
  while (!ends_.load()) {
    std::uint32_t tid = sends_.load();
    // The coordinator may have sent the thread home itself by now, and want another thread there.
    const bool is_asked = tid != 0 && tid != kNobody;
    if (is_asked && sends_.compare_exchange_strong(tid, tid | kSends)) {
      // The thread does not run meanwhile.
      executor_.Hold(static_cast<pid_t>(tid));
      BindTo(static_cast<pid_t>(tid), home_);
      std::uint32_t sent = tid | kSends;
      sends_.compare_exchange_strong(sent, 0);
    }
    if (!ends_.load()) syscall(SYS_futex, &sends_, FUTEX_WAIT_PRIVATE, 0, nullptr, nullptr, 0);
  }
}

// --- The coordinator
// ------------------------------------------------------------------------------

bool BesideCpu::IsFreeAt(std::uint64_t tsc) {
  if (tsc < not_before_tsc_) return false;
  if (tsc >= looks_for_claims_tsc_) {
    looks_for_claims_tsc_ = tsc + TicksIn(kClaimsBesideEveryNs);
    if (is_claimed_(cpu_)) LeaveToOthers(tsc);
  }
  return tsc >= not_before_tsc_;
}

bool BesideCpu::IsBusyAt(std::uint64_t tsc) const {
  return begun_ > 0 || tsc < begun_tsc_[next_begun_] + TicksIn(kBusyNs);
}

void BesideCpu::NoteWanted(std::uint64_t tsc) {
  begun_tsc_[next_begun_] = tsc;
  next_begun_ = (next_begun_ + 1) % begun_tsc_.size();
}

bool BesideCpu::Begin(HostThread& thread) {
  if (!warden_.joinable()) Start();
  if (!thread.is_beside) {
    // The thread sleeps at its gate, so that neither step takes time.
    if (!BindTo(thread.tid, cpu_)) {
      not_before_tsc_ = UINT64_MAX;
      return false;
    }
    executor_.LetGo(thread.tid);
    thread.may_run = false;
    thread.is_beside = true;
  }
  thread.turns_beside = true;
  thread.parked = false;
  ++begun_;
  const std::uint64_t tsc = HostTsc();
  NoteWanted(tsc);
  awake_until_tsc_.store(tsc + TicksIn(kAwakeNs));
  thread.slot_memory->saying.store(Saying::kRuns);
  const std::uint64_t place = asked_.load();
  gates_[place % kMostGates].store(thread.slot_memory);
  asked_.store(place + 1);
  if (sleeps_.exchange(0) != 0) Wake(sleeps_);
  return true;
}

// False if the thread's gate is open, or about to be.
bool BesideCpu::TakeBack(const HostThread& thread) {
  bool is_back = false;
  for (std::atomic<shm::ThreadSlot*>& gate : gates_) {
    shm::ThreadSlot* slot = thread.slot_memory;
    is_back |= slot != nullptr && gate.compare_exchange_strong(slot, nullptr);
  }
  return is_back;
}

bool BesideCpu::HasSaid(const HostThread& thread) {
  const Saying saying = thread.slot_memory->saying.load(std::memory_order_acquire);
  return saying == Saying::kSaid || saying == Saying::kSaidAndWaits;
}

std::uint64_t BesideCpu::StoppedAt(const HostThread& thread) {
  return std::clamp<std::uint64_t>(thread.slot_memory->stopped_tsc, thread.grant.base_tsc,
                                   HostTsc());
}

void BesideCpu::Take(HostThread& thread) {
  thread.turns_beside = false;
  --begun_;
  std::atomic<Saying>& saying = thread.slot_memory->saying;
  if (saying.exchange(Saying::kByPipe) == Saying::kSaidAndWaits) {
    syscall(SYS_futex, &saying, FUTEX_WAKE, 1, nullptr, nullptr, 0);
  }
}

bool BesideCpu::GiveUp(HostThread& thread) {
  if (TakeBack(thread)) {
    thread.parked = true;
  } else {
    // The opener may have been kept from the processor with the gate half open: a thread that
    // sleeps on at an open gate would be taken for one that the kernel holds.
    AwaitOpener();
  }
  Saying runs = Saying::kRuns;
  if (!thread.slot_memory->saying.compare_exchange_strong(runs, Saying::kByPipe)) return false;
  thread.turns_beside = false;
  --begun_;
  return true;
}

// Other threads may have the opener's processor, where the opener runs only when no other thread
// does: then the opener goes before them until it is done.
void BesideCpu::AwaitOpener() {
  const std::uint64_t until_tsc = HostTsc() + TicksIn(kMostOpenNs);
  bool is_helped = false;
  while (opens_.load()) {
    if (is_helped || HostTsc() < until_tsc) {
      _mm_pause();
      continue;
    }
    is_helped = true;
    if (!SetLevel(opener_tid_.load(), Level::kKernelOnly)) LeaveRealTime(opener_tid_.load());
  }
  if (is_helped) RunOnlyWhenIdle(opener_tid_.load());
}

void BesideCpu::Forget(HostThread& thread) {
  TakeBack(thread);
  // The thread's slot goes with the thread.
  AwaitOpener();
  thread.turns_beside = false;
  --begun_;
}

void BesideCpu::BringHome(HostThread& thread) {
  if (!std::exchange(thread.is_beside, false)) return;
  if (thread.parked || ThreadState(thread.tid) != 'R') {
    BindTo(thread.tid, home_);
    return;
  }
  auto asked = static_cast<std::uint32_t>(thread.tid);
  sends_.store(asked);
  Wake(sends_);
  const std::uint64_t until_tsc = HostTsc() + TicksIn(kMostWayBackNs);
  while (sends_.load() == asked && HostTsc() < until_tsc) _mm_pause();
  if (sends_.compare_exchange_strong(asked, 0)) {
    // The kernel holds the warden, which was asked.
    executor_.Hold(thread.tid);
    BindTo(thread.tid, home_);
    return;
  }
  // The warden has begun, and was held in the midst of it, perhaps: nothing else may touch the
  // thread.
  while (sends_.load() != 0) _mm_pause();
}

void BesideCpu::LeaveToOthers(std::uint64_t tsc) {
  // The count begins anew for a processor that was of use for longer than it had been left to
  // others.
  if (tsc > not_before_tsc_ + left_ticks_) left_to_others_ = 0;
  left_ticks_ = TicksIn(kLeftBesideNs << std::min(left_to_others_++, kMostDoublingsBeside));
  not_before_tsc_ = tsc + left_ticks_;
}

}  // namespace tcs
