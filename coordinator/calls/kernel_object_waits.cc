#include "coordinator/calls/kernel_object_waits.h"

#include <poll.h>
#include <unistd.h>

#include "coordinator/calls/call_files.h"
#include "coordinator/calls/syscall_semaphores.h"
#include "coordinator/port/proc_files.h"

namespace tcs {

namespace {

// The kernel has let the thread go on. The thread is on its way, or at its gate already where it
// runs although it is not dispatched.
bool HasComeBack(const Task& task) {
  if (ThreadState(task.tid) == 'R') return true;
  return task.slot >= 0 && !task.parked && SlotOf(task).gate.load() != shm::kGateOpen;
}

bool StillWaits(const Task& task) { return WouldWaitForSemaphores(task, task.trapped_call); }

}  // namespace

void KernelObjectWaits::Wait(Task& task, const shm::Notification& note, VirtualTime deadline) {
  const KernelObject object{.kind = note.args[0], .id = note.args[1]};
  objects_.Wait(task.order, object, note.args[2] != 0);
  if (note.args[3] > 0) {
    CallFiles::Keep(task, static_cast<int>(note.args[3] - 1));
  } else if (note.args[3] < 0) {
    CallFiles::KeepOn(task);
  }
  waker_.Wait(task, {awaited::Queue{object}, deadline});
}

void KernelObjectWaits::WaitInCall(Task& task, const KernelObject& object, VirtualTime deadline) {
  objects_.Wait(task.order, object, false);
  waker_.Wait(task, {awaited::Queue{object}, deadline, true});
}

bool KernelObjectWaits::Wake(std::int64_t kind, std::int64_t id, EventTime when) {
  if (kind == static_cast<std::int64_t>(shm::KernelObjectKind::kTerminals)) {
    FlushTerminals(when);
    return false;
  }
  if (kind == static_cast<std::int64_t>(shm::KernelObjectKind::kKernelWaits)) {
    return LookAtKernelWaits(when);
  }
  const std::vector<WaitQueues::Thread> waiters = objects_.WaitersFor({.kind = kind, .id = id});
  bool has_let_one_go = false, found = false;
  // A nanosecond apart, so that they try in this order on whatever cores they are.
  for (const WaitQueues::Thread thread : waiters) {
    Task& task = run_.table.At(thread);
    // The kernel would hold the threads for which nothing is left, and end their waits in its own
    // time.
    const bool is_in_call = task.wait.has_value() && task.wait->is_in_trapped_call;
    if (is_in_call && (has_let_one_go || StillWaits(task))) continue;
    has_let_one_go |= is_in_call;
    found = true;
    waker_.Wake(task, shm::WakeReason::kGo, when);
    when.at += VirtualNs(1);
  }
  return found;
}

bool KernelObjectWaits::LookAtKernelWaits(EventTime when) {
  bool found = false;
  for (Task& task : run_.table.tasks()) {
    if (task.state != TaskState::kUnseen || !HasComeBack(task)) continue;
    waker_.Wake(task, shm::WakeReason::kGo, when);
    task.parked = false;
    found = true;
  }
  return found;
}

// A worker of the kernel carries output from one end of a terminal to the other, in its own time;
// but a poll waits for that worker. The poll is made twice, because input at one end may be echoed
// to another.
void KernelObjectWaits::FlushTerminals(EventTime when) {
  for (int turn = 0; turn < 2; ++turn) {
    for (const Task& task : run_.table.tasks()) {
      const auto* wait = task.Awaits<awaited::Descriptors>();
      if (wait == nullptr || !wait->has_terminal) continue;
      for (const UniqueFd& fd : wait->fds) {
        pollfd probe{fd.get(), POLLIN, 0};
        poll(&probe, 1, 0);
      }
    }
  }
  terminals_written_(when);
}

void KernelObjectWaits::WakeAll(EventTime when) {
  LookAtKernelWaits(when);
  for (const KernelObject& object : objects_.AwaitedObjects()) {
    Wake(object.kind, object.id, when);
  }
}

}  // namespace tcs
