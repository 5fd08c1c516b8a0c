#include "coordinator/tasks/activations.h"

#include <algorithm>

namespace tcs {

namespace {

// Whether the process's DDS samples are being handed over: a sample has woken the threads that this
// wakes.
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

// Of the process's periodic timers: the earliest expiry that a thread which looked at `looked_ns`,
// and looks again at `now_ns`, cannot have seen before.
std::int64_t FirstExpiryAfter(const Process& process, std::int64_t looked_ns, std::int64_t now_ns) {
  std::int64_t first_ns = now_ns;
  for (const ProcessTimers::Armed& timer : process.timers.AllArmed()) {
    const std::int64_t next_ns = timer.setting.next_ns, interval_ns = timer.setting.interval_ns;
    if (interval_ns <= 0) continue;
    const std::int64_t into = (looked_ns - next_ns) % interval_ns;
    const std::int64_t expiry_ns = looked_ns - into + (into < 0 ? 0 : interval_ns);
    first_ns = std::min(first_ns, expiry_ns);
  }
  return first_ns;
}

}  // namespace

void Activations::Released(Task& task, shm::WakeReason reason, VirtualTime at,
                           VirtualDuration wakeup) const {
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
  activation.wakeup_ns = wakeup.ns();
  activation.charged_ns = std::max(activation.charged_ns, task.charged.ns());
  activation.priced_ns = task.priced.ns();
  if (task.slot >= 0) shm::NoteWoken(task.slot_memory->receipts);
  TellOfBeginning(task, activation.release_ns + activation.wakeup_ns);
}

void Activations::TellOfBeginning(const Task& task, std::int64_t at_ns) const {
  if (answers_ == nullptr) return;
  if (const auto who = answers_->WhoIs(task)) answers_->book().Ready(*who, at_ns);
}

// An activation that began with a receipt was released when the receipt's data arrived, as soon as
// that time is known.
void Activations::FindRelease(Activation& activation, const Task& task, unsigned receipt) const {
  if (answers_ == nullptr || has_own_clocks_ || activation.cause != ReleaseCause::kInput) return;
  activation.release_ns = answers_->book().ReleaseOf(task.order, receipt, activation.release_ns);
}

void Activations::TellOfEnd(const Task& task, unsigned receipt, std::int64_t end_ns,
                            std::int64_t charged_ns) const {
  if (answers_ == nullptr) return;
  const auto who = answers_->WhoIs(task);
  if (!who.has_value()) return;
  answers_->book().Ended(*who, task.activation, receipt, end_ns,
                         charged_ns - task.activation.charged_ns);
}

// False: the thread's wait ends its activation.
bool Activations::TellOfPause(const Task& task, std::int64_t at_ns, std::int64_t charged_ns) const {
  if (answers_ == nullptr || !pause_of_) return false;
  const auto who = answers_->WhoIs(task);
  if (!who.has_value()) return false;
  const auto pause = pause_of_(task);
  if (!pause.has_value()) return false;
  answers_->book().Pauses(*who, task.activation, 0, at_ns, charged_ns - task.activation.charged_ns,
                          *pause);
  return true;
}

void Activations::IsCutOff(const Task& task, VirtualTime end) const {
  Activation activation = task.activation;
  const std::int64_t end_ns = ProgramClock::At(end, task.lead).ns();
  if (activation.start_ns < 0) activation.start_ns = end_ns;
  if (answers_ == nullptr || activation.release_ns >= end_ns) return;
  const auto who = answers_->WhoIs(task);
  if (!who.has_value()) return;
  answers_->book().Ended(*who, activation, 0, end_ns,
                         std::max<std::int64_t>(0, task.charged.ns() - activation.charged_ns));
}

void Activations::Write(const Task& task, const Activation& activation, std::int64_t end_ns,
                        std::int64_t charged_ns, const shm::WorkCounts& work) {
  if (task.process->robot->is_ours) return;
  log_.Write(task.process->name, task.is_further ? task.order : 0, activation, end_ns,
             {.charged_ns = charged_ns, .priced_ns = task.priced.ns(), .work = work});
}

// The thread did not wait, and is at its next activation all the same (shm/receipts.h).
void Activations::Next(Task& task, ProgramTime now, VirtualDuration charged,
                       const shm::WorkCounts& work, const Receipt& receipt) {
  Activation& activation = task.activation;
  if (activation.start_ns < 0) activation.start_ns = activation.release_ns;
  if (receipt.number <= 1) FindRelease(activation, task, 0);
  const std::int64_t now_ns = std::max(now.ns(), activation.start_ns);
  const std::int64_t charged_ns = std::max(charged.ns(), activation.charged_ns);
  Write(task, activation, now_ns, charged_ns, work);
  // The activation that ends began with the receipt before.
  TellOfEnd(task, receipt.number == 0 ? 0 : receipt.number - 1, now_ns, charged_ns);
  ++task.activations;
  const std::int64_t before_ns = activation.start_ns;
  const bool by_message = receipt.of == shm::Receipts::Of::kMessage;
  activation = {.cause = by_message ? ReleaseCause::kInput : ReleaseCause::kTime,
                .release_ns = now_ns,
                .start_ns = now_ns,
                .charged_ns = charged_ns,
                .priced_ns = task.priced.ns(),
                .work = work};
  if (receipt.release_ns.has_value()) {
    activation.release_ns = *receipt.release_ns;
    activation.start_ns = std::max(now_ns, activation.release_ns);
  } else if (by_message) {
    if (receipt.number > 0) FindRelease(activation, task, receipt.number);
  } else if (answers_ != nullptr && !has_own_clocks_) {
    activation.release_ns = FirstExpiryAfter(*task.process, before_ns, now_ns);
  }
  TellOfBeginning(task, activation.start_ns);
}

void Activations::TakeReceipts(Task& task, ProgramTime now) {
  shm::Receipts& receipts = task.slot_memory->receipts;
  const std::uint32_t count = std::min(receipts.count.load(), shm::Receipts::kMost);
  for (std::uint32_t i = 0; i < count; ++i) {
    const shm::Receipts::Entry entry = receipts.entries[i];
    Receipt receipt{.number = i + 1, .of = entry.of};
    if (entry.of == shm::Receipts::Of::kSleep)
      receipt.release_ns = std::clamp<std::int64_t>(entry.release_ns, 0, now.ns());
    Next(task, std::min(OwnTime(entry.time_ns), now),
         std::min(VirtualNs(entry.cpu_ns), task.charged), WithTrapped(task, entry.work), receipt);
  }
  receipts.count.store(0);
  if (answers_ != nullptr) answers_->book().ForgetReceipts(task.order, count);
}

void Activations::ReceivedRaw(Task& task, bool of_timer) {
  if (task.slot < 0 || !shm::NoteReceived(task.slot_memory->receipts, task.charged.ns())) return;
  Next(task, OwnNow(task), task.charged, task.work,
       {.of = of_timer ? shm::Receipts::Of::kTimer : shm::Receipts::Of::kMessage});
}

void Activations::Idles(Task& task, bool dies) {
  const std::int64_t now = OwnNow(task).ns();
  task.process->expired = VirtualTime::Never();
  if (task.slot < 0) {  // the thread never began
    if (answers_ != nullptr) answers_->Dies(task);
    return;
  }
  if (task.activation.start_ns < 0) task.activation.start_ns = task.activation.release_ns;
  FindRelease(task.activation, task, 0);
  // The time of a switch is an estimate: a switch shorter than it gives back what was charged too
  // much. No activation is charged less than nothing for that; later activations are charged less.
  const std::int64_t charged = std::max(task.charged.ns(), task.activation.charged_ns);
  Write(task, task.activation, std::max(now, task.activation.start_ns), charged, task.work);
  const std::int64_t end_ns = std::max(now, task.activation.start_ns);
  // Nobody waits for what a program does at its end.
  const bool pauses = !dies && TellOfPause(task, end_ns, charged);
  if (!dies && !pauses) TellOfEnd(task, 0, end_ns, charged);
  if (answers_ != nullptr && !pauses) {
    dies ? answers_->Dies(task) : answers_->book().Idles(task.order);
  }
  task.activation.charged_ns = charged;
  task.activation.priced_ns = task.priced.ns();
  task.activation.work = task.work;
}

}  // namespace tcs
