#include "coordinator/calls/priority_inheritance.h"

namespace tcs {

void PriorityInheritance::Find(Task& task) {
  if (SchedulerOf(task).FindEffectivePriority(task.order)) waker_.Refresh(*task.process->robot);
}

void PriorityInheritance::BlockOn(Task& task, const Task* owner) {
  if (auto* lock = task.Awaits<awaited::Futex>(); lock != nullptr) {
    lock->owner = owner == nullptr ? awaited::kNobody : owner->order;
  }
  const bool inherits = owner != nullptr && owner->process->robot == task.process->robot;
  SchedulerOf(task).SetBlockedOn(task.order, inherits ? owner->order : RobotScheduler::kNobody);
}

void PriorityInheritance::Leave(Task& task) {
  const RobotScheduler::Thread owner = SchedulerOf(task).BlockedOn(task.order);
  BlockOn(task, nullptr);
  if (owner != RobotScheduler::kNobody) Find(run_.table.At(owner));
}

}  // namespace tcs
