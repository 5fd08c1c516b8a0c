// Waits for kernel objects that cannot be polled (calls/wait_queues.h), and what else others tell
// of when they do it: locks of files, and what is written to terminals.
#include <poll.h>
#include <unistd.h>

#include "coordinator/core/engine.h"

namespace tcs {

void Engine::WaitAtQueue(Task& task, const shm::Notification& note, std::int64_t deadline_ns) {
  const KernelObject object{.kind = note.args[0], .id = note.args[1]};
  queues_.Wait(task.order, object, note.args[2] != 0);
  EnterWait(task, {awaited::Queue{object}, deadline_ns});
}

// Something of that kind has been done to the object. True if it has woken anybody.
bool Engine::WakeQueue(std::int64_t kind, std::int64_t id, Moment moment) {
  if (kind == static_cast<std::int64_t>(shm::WaitKey::kTerminals)) {
    FlushTerminals();
    return false;
  }
  if (kind == static_cast<std::int64_t>(shm::WaitKey::kKernelWaits)) {
    return LookAtKernelWaits(moment);
  }
  const std::vector<WaitQueues::Thread> waiters = queues_.WaitersFor({.kind = kind, .id = id});
  // A nanosecond apart, so that they try in this order on whatever cores they are.
  for (const WaitQueues::Thread thread : waiters) {
    MakeReady(TaskAt(thread), shm::WakeReason::kGo, moment);
    ++moment.ns;
  }
  return !waiters.empty();
}

// Threads that the kernel holds in a call of theirs, and has just let go on. True if there are any.
bool Engine::LookAtKernelWaits(Moment moment) {
  bool found = false;
  for (Task& task : table_.tasks()) {
    if (task.state != TaskState::kUnseen || ThreadState(task.tid) != 'R') continue;
    MakeReady(task, shm::WakeReason::kGo, moment);
    task.parked = false;
    found = true;
  }
  return found;
}

// The kernel keeps the order of those who wait for a lock.
void Engine::LockRaw(Task& task) {
  task.trap_continues = true;
  task.expects_kernel = true;
  task.follow_up = FollowUp::kKernelWaits;
  HoldRaw(task, shm::NotificationKind::kWrite);
}

// What is written to one end of a terminal comes to the other one by a worker of the kernel, in its
// own time; but a poll waits for that worker. Twice, for what arrives at one end may be echoed to
// another.
void Engine::FlushTerminals() {
  for (int turn = 0; turn < 2; ++turn) {
    for (const Task& task : table_.tasks()) {
      const auto* wait = task.Awaits<awaited::Descriptors>();
      if (wait == nullptr || !wait->has_terminal) continue;
      for (const UniqueFd& fd : wait->fds) {
        pollfd probe{fd.get(), POLLIN, 0};
        poll(&probe, 1, 0);
      }
    }
  }
}

// A process that ends may change any object: the kernel undoes what it did to semaphores.
void Engine::WakeEveryQueue(Moment moment) {
  for (const KernelObject& object : queues_.AwaitedObjects()) {
    WakeQueue(object.kind, object.id, moment);
  }
}

}  // namespace tcs
