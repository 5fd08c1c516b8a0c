#include "coordinator/engine/clock_pages.h"

#include <algorithm>

#include "coordinator/calls/call_files.h"
#include "coordinator/engine/wiring.h"
#include "coordinator/tasks/cpu_clock.h"
#include "shm/clock_page.h"

namespace tcs {

namespace {

// No program has more charged before it comes to its gate.
constexpr VirtualDuration kMostUndispatched = VirtualDuration::Milliseconds(1);

}  // namespace

void ClockPages::GrantWhatIsSafe(const VirtualCpu& cpu, ClockGrant& grant) const {
  const bool world_stands = run_.IsCallback();
  grant.read_safe_ns = (world_stands ? cpu.progress : run_.root.ReadSafe(cpu.leaf)).ns();
  grant.local_read_safe_ns = (world_stands ? cpu.progress : run_.root.LocalReadSafe(cpu.leaf)).ns();
  grant.write_safe_ns = run_.root.WriteSafe(cpu.leaf).ns();
}

// The set costs of what a thread did on the way to its gate when it ran on undispatched, while the
// kernel held the thread whose turn it was (Settle). The next turn of the undispatched thread
// begins with these costs.
std::int64_t ClockPages::ChargedUndispatched(const Task& task) const {
  if (!run_.IsFixed()) return 0;
  const std::int64_t added_ns =
      shm::AdjustValue(SlotOf(task).clock.executed_adjust.load()) - task.settled_adjust_ns;
  return std::clamp<std::int64_t>(added_ns, 0, kMostUndispatched.ns());
}

void ClockPages::Write(Task& task, VirtualTime horizon, VirtualTime idle_until) {
  CallFiles::LookAtNumbers(task);
  shm::ThreadSlot& slot = SlotOf(task);
  shm::ClockPage& page = slot.clock;
  const VirtualCpu& cpu = *task.cpu;
  const ProgramClock& clock = task.process->clock;
  const ProgramTime now = clock.At(cpu.progress);
  MeteredThread& metered = task.metered;
  if (!metered.has_origin()) metered.host_origin_ns = HostClockOf(task);
  metered.pays_for_silence = task.process->client->pays_for_silence;
  ClockGrant& grant = task.grant;
  grant.base_time_ns = (now + task.debt).ns();
  grant.base_cpu_ns = task.charged.ns();
  grant.horizon_ns = clock.At(horizon).ns();
  grant.idle_until_ns = grant.most_idle_ns = idle_until.ns();
  GrantWhatIsSafe(cpu, grant);
  all_.host_cpu.SetRates(
      task, {.call = task.process->call_cost, .allocation = task.process->allocation_cost}, grant);
  // Without levels the shim looks at the beginning of each call whether the call may begin.
  grant.counts_work = run_.IsFixed() || run_.options.counts_work || run_.is_unprivileged ? 1 : 0;
  if (run_.is_unprivileged && task.trap_id != 0 && task.trap_continues) {
    grant.counts_work |= shm::kBeginsInCall;
  }
  grant.NoteLimits();
  // A thread that computes on meanwhile goes to its gate rather than read what is half written: the
  // thread has no horizon before it starts. A reading that has begun is repeated, for there is
  // another dispatch number.
  const std::int64_t added_ns = ChargedUndispatched(task);
  ++task.dispatches;
  page.executed_adjust.store(shm::PackAdjust(task.DispatchWord(), added_ns));
  page.waited_adjust.store(task.DispatchWord());
  ClockGrant written = grant;
  if (!all_.host_cpu.stands_still()) written.horizon_ns = 0;
  written.WriteTo(page);
  page.host_cpu_origin_ns = metered.page_origin_ns = metered.host_origin_ns;
  page.other_cpu_ns = task.process->threads == 1
                          ? task.process->ended.usage().charged_ns
                          : (UsageBook::ChargedTo(*task.process) - task.charged).ns();
  page.children_cpu_ns = task.process->children_cpu.ns();
  const std::int64_t last = page.last_shown_ns.load(std::memory_order_relaxed);
  page.last_shown_ns.store(std::max(last, now.ns()), std::memory_order_relaxed);
  page.last_shown_cpu_ns.store(task.charged.ns(), std::memory_order_relaxed);
  slot.core = cpu.core;
  const VirtualTime end_of_spin = all_.spins.EndOfSpin(task);
  slot.spin_until_ns = end_of_spin.IsNever() ? shm::kNeverNs : clock.At(end_of_spin).ns();
  // A thread that priority has stopped in the midst of its turn has had its answer, and a trapped
  // call is answered by its result. If a signal handler of its program lies on top of an exchange,
  // the slot has the content of that exchange, put back.
  if (task.parked && task.trap_id == 0) WriteAnswer(task);
}

void ClockPages::WriteAnswer(const Task& task) {
  shm::ThreadSlot& slot = SlotOf(task);
  slot.reply[0] = task.reply[0];
  slot.reply[1] = task.reply[1];
  slot.wake_reason.store(task.reason);
}

}  // namespace tcs
