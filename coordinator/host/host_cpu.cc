#include "coordinator/host/host_cpu.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "coordinator/port/clocks.h"
#include "coordinator/port/proc_files.h"
#include "coordinator/port/waits.h"

namespace tcs {

namespace {

// Longer than the coordinator takes from Dispatch() to Start(): 0.1 to 0.3 ms, whatever the TSC's
// rate.
constexpr std::uint64_t kLongTicks = 300'000;

// Time that some ways out of gates have not taken, others of the thread's may take, but not for
// ever.
constexpr HostDuration kMostWays = HostDuration::Milliseconds(2);
// Signals are let through again on the way.
constexpr HostDuration kLettingSignals = HostDuration::Microseconds(2);

// While this object lives, a thread's meter works on another page.
class OnPage {
 public:
  OnPage(MeteredThread& thread, shm::ClockPage* page)
      : thread_(thread), own_(std::exchange(thread.page, page)) {}
  ~OnPage() { thread_.page = own_; }
  OnPage(const OnPage&) = delete;
  OnPage& operator=(const OnPage&) = delete;

 private:
  MeteredThread& thread_;
  shm::ClockPage* const own_;
};

// A thread's CPU clock, asked at most once: each time is a system call.
class AskedOnce {
 public:
  explicit AskedOnce(const Meter::CpuClock& clock) : clock_(clock) {}
  Meter::CpuClock Clock() {
    return [this] {
      if (!ns_.has_value()) ns_ = clock_();
      return *ns_;
    };
  }

 private:
  const Meter::CpuClock& clock_;
  std::optional<std::int64_t> ns_;
};

}  // namespace

std::string HostCpu::Open(std::unique_ptr<Meter> meter) {
  meter_ = std::move(meter);
  return detector_.Start();
}

void HostCpu::Dispatch(HostThread& thread) {
  // Where something stops the coordinator before Start() (a tracer, SIGSTOP), the thread runs
  // meanwhile, by a clock that runs from here.
  if (thread.slot_memory != nullptr) {
    thread.slot_memory->clock.base_tsc = thread.grant.base_tsc = HostTsc();
  }
  active_.Dispatch(thread);
  from_gate_ = std::exchange(thread.parked, false);
  detector_.Arm();
}

void HostCpu::OpenGate(shm::ThreadSlot& slot) {
  if (slot.gate.exchange(shm::kGateOpen) == shm::kGateWaiting) {
    WakeAt(slot.gate);
  }
}

// From here on the TSC is the thread's.
void HostCpu::Start(HostThread& thread, bool is_silent) {
  Woke();
  thread.metered.TurnBegins();
  if (thread.slot_memory == nullptr) return;
  MeteredThread& metered = thread.metered;
  if (stop_tsc_ - thread.grant.base_tsc > kLongTicks) {
    // The thread may have run, and its clock is not to go back. The thread's CPU clock tells what
    // it had; the run tells nothing of switches.
    MeterOf(thread).Begin(metered, thread.grant.base_tsc, from_gate_, is_silent);
    metered.unchecked_runs = {};
    return;
  }
  thread.slot_memory->clock.base_tsc = thread.grant.base_tsc =
      MeterOf(thread).Begin(metered, stop_tsc_, from_gate_, is_silent);
}

void HostCpu::StartBeside(HostThread& thread, std::uint64_t tsc) {
  AllowWay(thread);
  thread.metered.TurnBegins();
  // The time that a switch takes there is not known, nor counted: the clock begins behind it. Nor
  // is anything to be learnt from it of switches here.
  MeterOf(thread).Begin(thread.metered, tsc, false, false);
  thread.metered.unchecked_runs = {};
  thread.slot_memory->clock.base_tsc = thread.grant.base_tsc = tsc;
}

void HostCpu::Woke() { stop_tsc_ = HostTsc(); }

// The time that the coordinator took meanwhile is not the thread's.
void HostCpu::Continue(HostThread& thread) {
  const std::uint64_t stopped_tsc = stop_tsc_;
  Woke();
  // If the thread runs on, its CPU clock tells; and its page is not to be touched.
  if (thread.slot_memory == nullptr || !stands_still()) return;
  shm::ClockPage& page = thread.slot_memory->clock;
  page.base_tsc = thread.grant.base_tsc += stop_tsc_ - stopped_tsc;
  // A new number, so that the thread repeats a reading that it was interrupted in.
  ++thread.dispatches;
  const std::uint64_t word = thread.DispatchWord();
  page.executed_adjust.store(shm::PackAdjust(word, shm::AdjustValue(page.executed_adjust.load())));
  page.waited_adjust.store(shm::PackAdjust(word, shm::AdjustValue(page.waited_adjust.load())));
}

// What the thread has taken out itself moved its origin; and it may have become another one
// meanwhile. The thread does not find again what is found stolen here: where the thread runs on
// undispatched it goes on with the clock that it has.
void HostCpu::End(HostThread& thread, const Meter::CpuClock& clock, shm::ClockPage* page) {
  const OnPage on_copy(thread.metered, page);
  AskedOnce asked(clock);
  const Meter::CpuClock once = asked.Clock();
  AllowOwnWork(thread, once);
  FollowOrigin(thread);
  // A thread beside may not have come to its gate yet: only at the gate does the kernel tell what
  // it has computed.
  thread.metered.can_be_audited = !thread.is_beside;
  std::uint64_t word = page->executed_adjust.load();
  const std::int64_t stolen_ns = page->stolen_ns.load();
  MeterOf(thread).End(thread.metered, stop_tsc_, once);
  const std::uint64_t corrected = page->executed_adjust.load();
  shm::ClockPage& own = thread.slot_memory->clock;
  if (corrected == word || !own.executed_adjust.compare_exchange_strong(word, corrected)) return;
  own.last_check_tsc.store(page->last_check_tsc.load());
  own.stolen_ns.fetch_add(page->stolen_ns.load() - stolen_ns);
}

void HostCpu::AllowWay(HostThread& thread) {
  HostDuration& ways = thread.metered.most_ways;
  const HostDuration most = thread.metered.OnEither(shm::kMostExchangeNs) + kLettingSignals;
  ways = std::max({ways, most, std::min(ways + most, kMostWays)});
}

void HostCpu::AllowAttach(HostThread& thread) {
  MeteredThread& metered = thread.metered;
  metered.most_ways = std::max(metered.most_ways, metered.OnEither(shm::kMostAttachNs));
}

// Where others share the processor the TSC counts their time, too.
HostDuration HostCpu::RanInTurn(const HostThread& thread, const Meter::CpuClock& clock) const {
  const MeteredThread& metered = thread.metered;
  const auto ticks = static_cast<std::int64_t>(stop_tsc_ - thread.grant.base_tsc);
  const HostDuration by_tsc = metered.OnHost(
      VirtualNs(shm::MulQ32(std::max<std::int64_t>(0, ticks), thread.grant.ns_per_tick_q32)));
  if (stands_still() || by_tsc == HostDuration()) return by_tsc;
  const std::int64_t cpu_ns = metered.turn_cpu_ns < 0 ? -1 : clock();
  return cpu_ns < 0 ? HostDuration() : std::min(by_tsc, HostNs(cpu_ns - metered.turn_cpu_ns));
}

void HostCpu::AllowOwnWork(HostThread& thread, const Meter::CpuClock& clock) const {
  thread.metered.own_work.Allow(RanInTurn(thread, clock),
                                [&] { return HostNs(ComputedBy(thread.tid).system_ns); });
}

// Without levels the thread may run, and move the origin on meanwhile: its page is left alone as
// long as what the page says can be.
void HostCpu::FollowOrigin(HostThread& thread) {
  MeteredThread& metered = thread.metered;
  if (!metered.has_origin()) return;
  shm::ClockPage& page = *metered.page;
  const HostDuration said = HostNs(metered.OriginMovedOn(page));
  const HostDuration most = metered.own_work.most() + metered.most_ways;
  const HostDuration moved = std::clamp(said, HostDuration(), most);
  const HostDuration own = std::min(moved, metered.own_work.most());
  metered.NoteOwnWorkOnPage(moved);
  metered.own_work.Believe(own);
  metered.most_ways -= moved - own;
  if (moved != said) page.host_cpu_origin_ns = metered.page_origin_ns;
}

VirtualDuration HostCpu::Uncharged(const HostThread& thread, VirtualDuration charged,
                                   const Meter::CpuClock& clock) {
  const MeteredThread& metered = thread.metered;
  if (metered.is_ideal) return {};
  const std::int64_t cpu_ns = metered.has_origin() ? clock() : -1;
  if (cpu_ns < 0) return {};
  return std::max(VirtualDuration(), metered.ChargeAt(cpu_ns) - charged);
}

void HostCpu::TakeOutWayToGate(HostThread& thread, VirtualDuration charged,
                               const Meter::CpuClock& clock) {
  constexpr HostDuration kMost = HostNs(shm::kMostExchangeNs);
  const HostDuration way = thread.metered.OnHost(Uncharged(thread, charged, clock));
  if (way <= kMost) thread.metered.NoteOwnWork(way);
}

shm::ClockReading HostCpu::ClockOf(const HostThread& thread) const {
  return shm::ReadClockAt(thread.slot_memory->clock, stop_tsc_);
}

HostDuration HostCpu::TimeToLook(HostThread& thread, ProgramTime horizon) {
  return MeterOf(thread).TimeToLook(thread.metered, stop_tsc_, horizon);
}

Meter::Found HostCpu::Look(HostThread& thread, ProgramTime horizon, const Meter::CpuClock& clock) {
  AskedOnce asked(clock);
  const Meter::CpuClock once = asked.Clock();
  AllowOwnWork(thread, once);
  FollowOrigin(thread);
  return MeterOf(thread).Look(thread.metered, stop_tsc_, horizon, once);
}

HostDuration HostCpu::TakeOutUnaccounted(HostThread& thread, const shm::ClockReading& before,
                                         HostDuration asked, const Meter::CpuClock& clock) {
  if (!MeterOf(thread).HasOverslept(before.tsc, stop_tsc_, asked) || !thread.HasOwnClock())
    return {};
  return MeterOf(thread).TakeOutUnaccounted(thread.metered, before, stop_tsc_, asked, clock);
}

void HostCpu::Check(HostThread& thread, const Meter::CpuClock& clock) {
  MeterOf(thread).Check(thread.metered, stop_tsc_, clock);
}

void HostCpu::ChargeCall(HostThread& thread, VirtualDuration cost, shm::ClockPage* page) {
  const OnPage on_copy(thread.metered, page);
  MeterOf(thread).ChargeCall(thread.metered, cost);
}

}  // namespace tcs
