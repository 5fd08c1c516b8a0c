// Waiting for kernel objects that cannot be polled (System V IPC), by the kind and number of the
// object. Whoever changes one wakes all that wait for it, in the order in which they came; each
// tries again, and comes back to its place if that was not for it.
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <vector>

#include "coordinator/core/engine.h"

namespace tcs {

void Engine::WaitForKey(Task& task, const shm::Notification& note) {
  SetState(task, TaskState::kWaiting);
  task.waits_for_key = true;
  task.key_kind = note.args[0];
  task.key_id = note.args[1];
  if (note.args[2] == 0) task.key_order = ++key_counter_;
  header_->key_waiters.store(++key_waiters_);
}

void Engine::EndKeyWait(Task& task) {
  if (!task.waits_for_key) return;
  task.waits_for_key = false;
  header_->key_waiters.store(--key_waiters_);
}

bool Engine::WakeKey(std::int64_t kind, std::int64_t id, Moment moment) {
  if (kind == static_cast<std::int64_t>(shm::WaitKey::kTerminals)) {
    FlushTerminals();
    return false;
  }
  if (kind == static_cast<std::int64_t>(shm::WaitKey::kKernelWaits))
    return LookAtKernelWaits(moment);
  std::vector<Task*> waiting;
  for (Task& task : tasks_) {
    if (task.waits_for_key && task.key_kind == kind && task.key_id == id) waiting.push_back(&task);
  }
  std::sort(waiting.begin(), waiting.end(),
            [](const Task* a, const Task* b) { return a->key_order < b->key_order; });
  // A nanosecond apart, so that they try in this order on whatever cores they are.
  for (Task* task : waiting) {
    MakeReady(*task, shm::WakeReason::kGo, moment);
    ++moment.ns;
  }
  return !waiting.empty();
}

// Threads that the kernel holds in a call of theirs, and has just let go on. True if there are any.
bool Engine::LookAtKernelWaits(Moment moment) {
  bool found = false;
  for (Task& task : tasks_) {
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

void Engine::NoteTerminal(Task& task, int fd) {
  struct stat status {};
  if (task.watches_terminal || fstat(fd, &status) != 0 || !S_ISCHR(status.st_mode) || !isatty(fd)) {
    return;
  }
  task.watches_terminal = true;
  header_->key_waiters.store(++key_waiters_);
}

// What is written to one end of a terminal comes to the other one by a worker of the kernel, in its
// own time; but a poll waits for that worker. Twice, for what arrives at one end may be echoed to
// another.
void Engine::FlushTerminals() {
  for (int turn = 0; turn < 2; ++turn) {
    for (const Task& task : tasks_) {
      if (!task.watches_terminal) continue;
      for (const int fd : task.watched) {
        pollfd probe{fd, POLLIN, 0};
        poll(&probe, 1, 0);
      }
    }
  }
}

// A process that ends may change any object: the kernel undoes what it did to semaphores.
void Engine::WakeEveryKey(Moment moment) {
  if (key_waiters_ == 0) return;
  for (const Task& task : tasks_) {
    if (task.waits_for_key) WakeKey(task.key_kind, task.key_id, moment);
  }
}

}  // namespace tcs
