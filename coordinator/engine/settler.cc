#include "coordinator/engine/settler.h"

#include <sys/syscall.h>

#include <algorithm>

#include "coordinator/calls/ipc_notes.h"
#include "coordinator/engine/wiring.h"
#include "coordinator/host/preemption_timer.h"
#include "coordinator/host/settlement.h"
#include "coordinator/os/trap.h"
#include "coordinator/tasks/cpu_clock.h"
#include "shm/clock_page.h"

namespace tcs {

void Settler::TakeOutUnaccounted(Task& task, const shm::ClockReading& before, HostDuration asked) {
  const HostDuration stolen =
      all_.host_cpu.TakeOutUnaccounted(task, before, asked, CpuClockOf(task));
  if (stolen <= HostDuration()) return;
  run_.report.unaccounted_steal_ns += stolen.ns();
  ++run_.report.unaccounted_steals;
}

bool Settler::TakeNotesOf(Task& task) {
  const char* what = TakeIpcNotes(task, *all_.memory, run_.first_realtime_offset_ns.has_value());
  if (what == nullptr) what = all_.datagrams.TakeNotes(task, task.cpu->progress);
  if (what != nullptr) all_.violations.EndProcess(*task.process, what);
  return what == nullptr;
}

void Settler::Settle(Task& task) {
  if (task.slot < 0) return;
  // Other threads of the process may write to the slot meanwhile: the values that are checked are
  // those that are reckoned with.
  shm::ThreadSlot& slot = SlotOf(task);
  shm::ClockPage page;
  shm::CopyPage(slot.clock, &page);
  const shm::NotificationKind kind = slot.note.kind;
  const std::int64_t noted_ns = slot.note.time_ns;
  const char* what = all_.slot_check.WhatIsImpossible(task, page);
  // The thread's receptions are taken before the ends of its activations are told; no clock is past
  // the horizon.
  const VirtualTime furthest =
      run_.IsCallback() ? task.cpu->progress : std::max(task.cpu->progress, run_.turn.horizon());
  if (what == nullptr) what = all_.datagrams.TakeNotes(task, furthest);
  if (what == nullptr) what = all_.posted.Take(task);
  if (what != nullptr) {
    task.ComeTo(task.cpu->progress);
    all_.violations.EndProcess(*task.process, what);
    return;
  }
  MeteredThread& metered = task.metered;
  const bool ends = run_.turn.trapped.has_value() && IsEnd(*run_.turn.trapped);
  if (ends) metered.AuditAtEnd();
  all_.host_cpu.End(task, CpuClockOf(task), &page);
  // The thread's own word does not have what is charged here.
  task.settled_adjust_ns = shm::AdjustValue(page.executed_adjust.load());
  // The shim counts and charges the calls that it sees, whatever the C library calls for it.
  const bool made_unseen_call = run_.turn.trapped.has_value() &&
                                run_.turn.trapped->number != SYS_exit && slot.signals.load() == 0;
  if (made_unseen_call) {
    all_.host_cpu.ChargeCall(task, task.process->call_cost, &page);
  }
  const shm::ClockReading reading = shm::ReadClockAt(page, all_.host_cpu.stop_tsc());
  ProgramClock& clock = task.process->clock;
  const auto on_robot = [&clock](std::int64_t own_ns) {
    return clock.RobotTimeOf(OwnTime(own_ns));
  };
  const VirtualTime start = task.cpu->progress;
  // A thread must not have left behind the threads that it has woken further than the drift bound,
  // however long ago it sent what woke them: the time computed beyond is a debt.
  if (!run_.IsCallback()) {
    run_.turn.LimitTo(run_.root.Horizon(task.cpu->leaf));
  }
  StoppedRun run{
      .start = start,
      .horizon = run_.turn.horizon(),
      .reached = on_robot(reading.time_ns),
      .shown = on_robot(shm::ShownTime(page, reading)),
      .most_overhead = metered.OnRobot(metered.OnEither(shm::kMostExchangeNs)),
      .is_preempted = run_.turn.timed_out && (!run_.turn.notified || run_.turn.is_sent_to_gate),
      .credit = -task.debt,
      .in_steps = task.metered.is_watched};
  if (run_.turn.notified && kind != shm::NotificationKind::kYield) {
    run.noted = on_robot(noted_ns);
    run.shown = std::max(on_robot(page.last_shown_ns.load()), *run.noted);
  }
  const auto [progress, debt, exchange_overhead] = SettleRun(run);
  metered.NoteOwnWork(metered.OnHost(exchange_overhead));
  const VirtualDuration charged =
      std::max(VirtualDuration(), VirtualNs(reading.cpu_ns) - exchange_overhead);
  const VirtualDuration executed = std::max(VirtualDuration(), charged - task.charged);
  const HostDuration host = metered.OnHost(executed);
  run_.report.client_ns += host.ns();
  task.ran = host;
  metered.longest_run = HostNs(PreemptionTimer::LongestOfLate(metered.longest_run.ns(), host.ns()));
  task.charged = charged;
  task.cpu->busy += executed;
  task.debt = debt;
  all_.activations.TakeReceipts(task, clock.At(progress));
  task.trapped_calls += made_unseen_call;
  task.work = WithTrapped(task, slot.work);
  if (run_.IsCallback()) {
    // The world stood still meanwhile: only the program's own clock has moved.
    const VirtualDuration computed = progress - start;
    const ProgramTime begun = clock.At(start);
    clock.NoteHeld(start, computed);
    clock.Advance(start, computed);
    task.lead = clock.lead();
    run_.most_lead = std::max(run_.most_lead, task.lead);
    all_.records.Ran(task, {begun, clock.At(start)}, {start, start}, all_.host_cpu.stop_tsc());
    TakeNotesOf(task);
    return;
  }
  task.cpu->ComeTo(progress);
  task.ComeTo(progress);
  // Should the thread run on undispatched, while the kernel holds the thread whose turn it is, it
  // comes to its gate when it next looks at its clock: others may have gone on since.
  slot.clock.horizon_ns = task.grant.horizon_ns = 0;
  if (Waker::IsRunnable(task)) all_.waker.Requeue(task);
  TakeNotesOf(task);
  const bool slept = shm::AdjustValue(reading.waited_word) != 0;
  if (slept) SchedulerOf(task).SleptSince(task.order, progress - start);
  const VirtualTime busy_until = slept ? std::min(progress, start + executed) : progress;
  all_.records.Ran(task, {clock.At(start), clock.At(busy_until)}, {start, busy_until},
                   all_.host_cpu.stop_tsc());
}

}  // namespace tcs
