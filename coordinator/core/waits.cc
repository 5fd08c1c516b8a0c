// Where waits begin and end; wait.h says of what kinds they are.
#include <utility>

#include "coordinator/core/engine.h"
#include "coordinator/os/host.h"
#include "shm/check.h"

namespace tcs {

void Engine::EnterWait(Task& task, Wait wait) {
  TCS_CHECK(!task.wait.has_value());
  wait_counts_.Entered(wait);
  ShowObjectWaiters();
  const bool ends_by_signal = SignalsThatEnd(wait) != 0;
  task.wait = std::move(wait);
  SetState(task, TaskState::kWaiting);
  // One of them may be pending already.
  if (ends_by_signal) EndAwait(task, SignalsOf(task), {task.reached_ns});
}

// Whatever the thread waits for, it waits no longer.
void Engine::LeaveWait(Task& task) {
  const std::optional<Wait> left = std::exchange(task.wait, std::nullopt);
  if (!left.has_value()) return;
  wait_counts_.Left(*left);
  ShowObjectWaiters();
  if (const auto* descriptors = left->As<awaited::Descriptors>()) EndWatches(*descriptors);
  futexes_.Leave(task.order);
  queues_.Leave(task.order);
  LeaveLock(task);
}

// So that those whom nobody waits for need not tell of what they do.
void Engine::ShowObjectWaiters() {
  const auto waiters = static_cast<std::uint32_t>(wait_counts_.for_objects());
  if (header_->key_waiters.load(std::memory_order_relaxed) != waiters) {
    header_->key_waiters.store(waiters);
  }
}

}  // namespace tcs
