#include "coordinator/engine/notification_receiver.h"

#include <sys/types.h>

#include "coordinator/engine/wiring.h"
#include "coordinator/port/waits.h"
#include "coordinator/tasks/cpu_clock.h"
#include "shm/attach_protocol.h"

namespace tcs {

PollOutcome NotificationReceiver::Arrived(Task& task, EventTime when) {
  task.executes = false;
  if (SlotOf(task).note.kind == shm::NotificationKind::kPreempted) task.has_signal = false;
  if (all_.undispatched.WentToGate(task)) return {};
  all_.ahead.HasSpoken(task);
  if (run_.turn.IsOf(task)) {
    if (run_.is_unprivileged && all_.gate_keeper.MayGoOn(task)) return {.looks_again = true};
    run_.turn.notified = true;
  } else if (task.state == TaskState::kWaiting &&
             SlotOf(task).note.kind == shm::NotificationKind::kInterrupted) {
    HandlerCame(task, when);
  } else if (task.state == TaskState::kUnseen) {
    all_.unseen_threads.ComeBack(task, when);
    task.parked = true;
    all_.host_cpu.Check(task, CpuClockOf(task));
    PollOutcome found = kConcernsAll;
    found.looks_again = Handle(task);
    return found;
  } else if (!task.parked || task.trap_id != 0) {
    // The thread ran on while the coordinator slept for a thread that the kernel held; or a signal
    // from outside has ended its trapped call.
    if (task.state == TaskState::kWaiting) all_.waker.Wake(task, shm::WakeReason::kSignal, when);
    all_.gate_keeper.ChargeUndispatched(task);
    task.trap_id = 0;
    task.notified_early = true;
  } else if (SlotOf(task).note.kind == shm::NotificationKind::kInterrupted) {
    // The kernel let the thread run a handler before its turn, which is to answer what the thread
    // said before. The time at which the thread says so depends on the host, and is no concern of a
    // thread that has a turn.
    HandlerCame(task, when);
    return {};
  }
  return kConcernsAll;
}

// A handler has interrupted what the thread said, and is to run at its next turn.
void NotificationReceiver::HandlerCame(Task& task, EventTime when) {
  if (task.state != TaskState::kWaiting) {
    SlotOf(task).note.kind = shm::NotificationKind::kResumed;
    return;
  }
  all_.waker.Wake(task, shm::WakeReason::kSignal, when);
  task.reply[0] = 1;
}

bool NotificationReceiver::Handle(Task& task) {
  const shm::ThreadSlot& slot = SlotOf(task);
  const shm::Notification said = slot.note;
  if (said.kind != shm::NotificationKind::kInterrupted)
    return all_.notifications.Handle(task, said);
  const shm::Notification interrupted = slot.interrupted;
  const bool finds_more = all_.notifications.Handle(task, interrupted);
  if (!task.process->violates_protocol) HandlerCame(task, {task.reached});
  return finds_more;
}

bool NotificationReceiver::PutOff(Task& task) {
  return all_.gate_keeper.PutOff(&task, [this, &task, tid = task.tid](EventTime at) {
    // The thread may have ended meanwhile.
    if (run_.table.Living(tid) != &task) return PollOutcome{};
    task.is_put_off = false;
    return Arrived(task, at);
  });
}

PollOutcome NotificationReceiver::Take(const Process& process, EventTime when) {
  constexpr std::size_t kAtOnce = 64;
  if (process.link == nullptr) return {};
  shm::PipeMessage messages[kAtOnce];
  const ssize_t bytes = ReadPipe(process.link->incoming_fd(), messages, sizeof messages);
  const std::size_t count = bytes > 0 ? static_cast<std::size_t>(bytes) / sizeof messages[0] : 0;
  PollOutcome found;
  for (std::size_t i = 0; i < count; ++i) {
    Task* task = process.link == nullptr ? nullptr : process.link->TaskAt(messages[i].slot);
    if (task == nullptr || task->state == TaskState::kDead) continue;
    if (all_.gate_keeper.IsSaidBeforeTurn(*task, messages[i])) continue;
    // A thread that says so again and again is heard once.
    if (!task->is_put_off && run_.is_unprivileged) task->is_put_off = PutOff(*task);
    if (!task->is_put_off) found |= Arrived(*task, when);
  }
  return found;
}

}  // namespace tcs
