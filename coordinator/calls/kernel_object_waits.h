// Waits for kernel objects that cannot be polled (queues/wait_queues.h), and other changes that
// threads tell of when they make them: locks of files, and output to terminals.
//
// For the coordinator's thread only.
#pragma once

#include <cstdint>
#include <functional>
#include <utility>

#include "coordinator/queues/wait_queues.h"
#include "coordinator/tasks/run_state.h"
#include "coordinator/tasks/waker.h"
#include "shm/layout.h"

namespace tcs {

class KernelObjectWaits {
 public:
  // `terminals_written` is called when all that was written to terminals until that moment can be
  // read.
  KernelObjectWaits(RunState& run, Waker& waker, std::function<void(EventTime)> terminals_written)
      : run_(run), waker_(waker), terminals_written_(std::move(terminals_written)) {}

  // The thread waits as the notification kWaitObject says.
  void Wait(Task& task, const shm::Notification& note, VirtualTime deadline);
  // The same for a call made raw, which the kernel carries out once it need not wait.
  void WaitInCall(Task& task, const KernelObject& object, VirtualTime deadline);
  // The thread waits no longer.
  void Leave(const Task& task) { objects_.Leave(task.order); }
  // The thread has ended.
  void Forget(const Task& task) { objects_.Forget(task.order); }

  // Something of that kind (shm::KernelObjectKind) has been done to the object. True if that has
  // woken a thread.
  bool Wake(std::int64_t kind, std::int64_t id, EventTime when);
  // A process that ends may change any object: the kernel undoes what it did to semaphores.
  void WakeAll(EventTime when);
  // Wakes the threads that the kernel held in a call of theirs, and has just let go on. True if
  // there are any.
  bool LookAtKernelWaits(EventTime when);

  const WaitQueues& queues() const { return objects_; }

  // Something was written to a terminal.
  void FlushTerminals(EventTime when);

 private:
  RunState& run_;
  Waker& waker_;
  std::function<void(EventTime)> terminals_written_;
  WaitQueues objects_;
};

}  // namespace tcs
