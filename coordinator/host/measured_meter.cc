#include "coordinator/host/measured_meter.h"

#include <algorithm>
#include <atomic>

#include "coordinator/host/settlement.h"
#include "coordinator/host/stolen_time.h"

namespace tcs {

namespace {

// More than what clocks and the coordinator's estimates differ by in one dispatch.
constexpr std::int64_t kSlackNs = 10'000'000;

// A thread asks its own CPU clock, and says that it has. After the thread has run so much it is not
// believed.
constexpr HostDuration kAuditAfter = HostDuration::Milliseconds(1);

// Programs that hand work to each other are preempted once in each of their turns, so that all runs
// between two looks at their CPU clocks are of both kinds, and tell of neither. So after this many
// runs one of each kind is looked at by itself.
constexpr std::uint32_t kRunsBetweenSingles = 32;

// True if more time than the thread has run was taken out of its clock, as stolen: by its program,
// or because the host's clocks do not agree.
bool HasTakenTooMuch(const shm::ClockPage& page, std::uint64_t tsc) {
  const std::int64_t ran_ns =
      shm::MulQ32(static_cast<std::int64_t>(tsc - page.base_tsc), page.ns_per_tick_q32);
  return shm::AdjustValue(page.executed_adjust.load()) <
         -kSlackNs - std::max<std::int64_t>(0, ran_ns);
}

}  // namespace

void MeasuredMeter::SetRates(const MeteredThread& thread, const SetCosts&,
                             ClockGrant& grant) const {
  grant.ns_per_host_ns_q32 = thread.NsPerHostNsQ32();
  grant.ns_per_tick_q32 =
      static_cast<std::uint64_t>(static_cast<double>(rate_.ns_per_tick_q32) / thread.speed);
  grant.check_after_ticks =
      static_cast<std::uint64_t>(static_cast<double>(kCheckAfter.ns()) * rate_.ticks_per_ns);
  grant.call_cost_ns = grant.allocation_cost_ns = 0;
}

std::uint64_t MeasuredMeter::Begin(MeteredThread& thread, std::uint64_t tsc, bool from_gate, bool) {
  thread.checked_tsc = tsc - thread.unchecked_ticks;
  thread.page->last_check_tsc.store(thread.checked_tsc, std::memory_order_relaxed);
  thread.unchecked_runs.Add(from_gate);
  thread.Excuse(HostNs(static_cast<std::int64_t>(switch_costs_.ExcusedNs(from_gate))));
  return tsc + static_cast<std::uint64_t>(switch_costs_.Ns(from_gate) * rate_.ticks_per_ns);
}

HostDuration MeasuredMeter::TimeToLook(MeteredThread& thread, std::uint64_t tsc,
                                       ProgramTime horizon) {
  const ProgramTime now = OwnTime(shm::ReadClockAt(*thread.page, tsc).time_ns);
  const double left_ns = static_cast<double>(PassedBetween(now, horizon).ns()) * thread.speed;
  thread.asked_tsc = tsc;
  thread.asked = HostNs(timer_.NsToSleep(left_ns, thread.longest_run.ns()));
  return thread.asked;
}

Meter::Found MeasuredMeter::Look(MeteredThread& thread, std::uint64_t tsc, ProgramTime horizon,
                                 const CpuClock& clock) {
  timer_.Expired(thread.asked.ns(), NsBetween(thread.asked_tsc, tsc));
  CheckIfDue(thread, tsc, clock);
  const ProgramTime now = OwnTime(shm::ReadClockAt(*thread.page, tsc).time_ns);
  return IsAtHorizon(now, OwnTime(thread.page->base_time_ns), horizon, thread.is_watched)
             ? Found::kAtHorizon
             : Found::kGoesOn;
}

// Had the timer come in time, a look at the TSC is all there is to do.
bool MeasuredMeter::HasOverslept(std::uint64_t since_tsc, std::uint64_t tsc,
                                 HostDuration asked) const {
  const auto most_ns = static_cast<double>(asked.ns() + kMostTimerLatenessNs);
  return tsc - since_tsc > static_cast<std::uint64_t>(most_ns * rate_.ticks_per_ns);
}

HostDuration MeasuredMeter::TakeOutUnaccounted(MeteredThread& thread,
                                               const shm::ClockReading& before, std::uint64_t tsc,
                                               HostDuration asked, const CpuClock& clock) {
  Check(thread, tsc, clock);  // the CPU clock tells of most thieves
  shm::ClockPage& page = *thread.page;
  const shm::ClockReading now = shm::ReadClockAt(page, tsc);
  const std::int64_t shown_ns = page.last_shown_ns.load(std::memory_order_relaxed);
  const HostDuration stolen = HostNs(UnaccountedSteal(
      {.counted_ns = thread.OnHost(VirtualNs(now.cpu_ns - before.cpu_ns)).ns(),
       .asked_ns = asked.ns(),
       .usual_ns = thread.longest_run.ns(),
       .shown_ns = thread.OnHost(PassedBetween(OwnTime(before.time_ns), OwnTime(shown_ns))).ns()}));
  if (stolen <= HostDuration()) return {};
  shm::RemoveUnaccounted(page, now, stolen.ns());
  thread.NoteOriginMoved(stolen);
  return stolen;
}

void MeasuredMeter::Check(MeteredThread& thread, std::uint64_t tsc, const CpuClock& clock) {
  shm::ClockPage& page = *thread.page;
  const shm::ClockReading reading = shm::ReadClockAt(page, tsc);
  const std::int64_t cpu_ns = clock();
  if (cpu_ns < 0) return;
  // Only runs that the thread has not checked in between say something about switches.
  if (page.last_check_tsc.load(std::memory_order_relaxed) == thread.checked_tsc) {
    const std::int64_t stolen_ns = reading.cpu_ns - shm::CpuTimeFromHostClock(page, cpu_ns);
    switch_costs_.Learn(thread.unchecked_runs, static_cast<double>(stolen_ns) * thread.speed);
  }
  thread.unchecked_runs = {};
  thread.unaudited_ticks = 0;
  shm::RemoveStolen(page, reading, cpu_ns);
}

void MeasuredMeter::CheckIfDue(MeteredThread& thread, std::uint64_t tsc, const CpuClock& clock) {
  const shm::ClockPage& page = *thread.page;
  if (shm::IsCheckDue(page, shm::ReadClockAt(page, tsc))) Check(thread, tsc, clock);
}

// True for a run that is the first since the last look at the thread's CPU clock, and that is
// wanted by itself.
bool MeasuredMeter::IsSingleToLookAt(const MeteredThread& thread) {
  ++runs_since_singles_;
  const UncheckedRuns& runs = thread.unchecked_runs;
  const bool is_single =
      runs.count == 1 && thread.page->last_check_tsc.load() == thread.checked_tsc;
  const bool from_gate = runs.from_gate == 1;
  if (!is_single || from_gate == last_single_from_gate_) return false;
  if (from_gate && runs_since_singles_ < kRunsBetweenSingles) return false;
  last_single_from_gate_ = from_gate;
  runs_since_singles_ = 0;
  return true;
}

// True if the thread has run so much without being asked by the coordinator.
bool MeasuredMeter::IsAuditDue(const MeteredThread& thread) const {
  const auto most_ticks = static_cast<double>(kAuditAfter.ns()) * rate_.ticks_per_ns;
  return thread.can_be_audited && static_cast<double>(thread.unaudited_ticks) > most_ticks;
}

void MeasuredMeter::End(MeteredThread& thread, std::uint64_t tsc, const CpuClock& clock) {
  thread.unaudited_ticks += tsc - thread.page->base_tsc;
  if (IsSingleToLookAt(thread) || thread.is_watched || IsAuditDue(thread) ||
      HasTakenTooMuch(*thread.page, tsc)) {
    Check(thread, tsc, clock);
  } else {
    CheckIfDue(thread, tsc, clock);
  }
  thread.unchecked_ticks = tsc - thread.page->last_check_tsc.load(std::memory_order_relaxed);
}

}  // namespace tcs
