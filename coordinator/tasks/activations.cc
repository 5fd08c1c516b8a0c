#include "coordinator/tasks/activations.h"

#include <algorithm>

namespace tcs {

namespace {

// Whether the process's DDS samples are being handed over: whom this wakes, a sample has woken.
bool IsTakingSamples(const Process& process) {
  const Task* deliverer = process.deliverer;
  return deliverer != nullptr && deliverer->Awaits<awaited::Messages>() == nullptr;
}

ReleaseCause CauseOf(const Task& task, shm::WakeReason reason) {
  if (task.Awaits<awaited::Messages>() != nullptr) return ReleaseCause::kInput;
  if (reason == shm::WakeReason::kDeadline) return ReleaseCause::kTime;
  if (!task.process->expired.IsNever()) return ReleaseCause::kTime;
  if (reason == shm::WakeReason::kSignal) return ReleaseCause::kSignal;
  if (task.Awaits<awaited::Futex>() != nullptr) {
    return IsTakingSamples(*task.process) ? ReleaseCause::kInput : ReleaseCause::kThread;
  }
  const bool for_child = task.Awaits<awaited::Child>() != nullptr;
  return for_child ? ReleaseCause::kChild : ReleaseCause::kInput;
}

}  // namespace

void Activations::Released(Task& task, shm::WakeReason reason, VirtualTime at) const {
  Process& process = *task.process;
  Activation& activation = task.activation;
  activation.cause = CauseOf(task, reason);
  const bool by_deadline = reason == shm::WakeReason::kDeadline;
  const VirtualTime due = by_deadline ? task.wait->deadline : process.expired;
  activation.release_ns = std::min(at, due).ns();
  // A program's clock does not go back to the world's.
  if (has_own_clocks_)
    activation.release_ns = std::max(activation.release_ns, process.clock.shown().ns());
  activation.start_ns = -1;
  activation.charged_ns = std::max(activation.charged_ns, task.charged.ns());
  if (task.slot >= 0) shm::NoteWoken(task.slot_memory->receipts);
}

// It did not wait, and is at its next activation all the same (shm/receipts.h).
void Activations::Next(Task& task, ProgramTime now, VirtualDuration charged,
                       const shm::WorkCounts& work, bool of_timer) {
  Activation& activation = task.activation;
  if (activation.start_ns < 0) activation.start_ns = activation.release_ns;
  const std::int64_t now_ns = std::max(now.ns(), activation.start_ns);
  const std::int64_t charged_ns = std::max(charged.ns(), activation.charged_ns);
  log_.Write(task.process->name, task.is_further ? task.order : 0, activation, now_ns, charged_ns,
             work);
  ++task.activations;
  activation = {of_timer ? ReleaseCause::kTime : ReleaseCause::kInput, now_ns, now_ns, charged_ns,
                work};
}

void Activations::TakeReceipts(Task& task, ProgramTime now) {
  shm::Receipts& receipts = task.slot_memory->receipts;
  const std::uint32_t count = std::min(receipts.count.load(), shm::Receipts::kMost);
  for (std::uint32_t i = 0; i < count; ++i) {
    const shm::Receipts::Entry entry = receipts.entries[i];
    Next(task, std::min(OwnTime(entry.time_ns), now),
         std::min(VirtualNs(entry.cpu_ns), task.charged), WithTrapped(task, entry.work),
         entry.of == shm::Receipts::Of::kTimer);
  }
  receipts.count.store(0);
}

void Activations::ReceivedRaw(Task& task, bool of_timer) {
  if (task.slot < 0 || !shm::NoteReceived(task.slot_memory->receipts, task.charged.ns())) return;
  Next(task, OwnNow(task), task.charged, task.work, of_timer);
}

void Activations::Idles(Task& task) {
  const std::int64_t now = OwnNow(task).ns();
  task.process->expired = VirtualTime::Never();
  if (task.slot < 0) return;  // it never began
  if (task.activation.start_ns < 0) task.activation.start_ns = task.activation.release_ns;
  // What a switch takes is an estimate: one shorter than it gives back what was charged too much.
  // No activation is charged less than nothing for that; those that follow are charged less.
  const std::int64_t charged = std::max(task.charged.ns(), task.activation.charged_ns);
  log_.Write(task.process->name, task.is_further ? task.order : 0, task.activation,
             std::max(now, task.activation.start_ns), charged, task.work);
  task.activation.charged_ns = charged;
  task.activation.work = task.work;
}

}  // namespace tcs
