// One turn of a thread on a processor of the host: from its dispatch until it has stopped and was
// charged. While the turn lasts, every event that the kernel tells of is the thread's doing, or
// finds the thread stopped halfway.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>

#include "coordinator/port/traps.h"
#include "coordinator/tasks/task.h"

namespace tcs {

class Turn {
 public:
  // The data of a turn stays until the next turn begins.
  void Begin(Task& task, VirtualTime horizon) {
    *this = {};
    task_ = &task;
    horizon_ = horizon;
  }
  void End() { task_ = nullptr; }

  // The thread whose turn it is; null between two turns.
  Task* task() const { return task_; }
  bool lasts() const { return task_ != nullptr; }
  bool IsOf(const Task& task) const { return &task == task_; }
  bool IsIn(const Process& process) const { return lasts() && task_->process == &process; }
  bool IsOn(const Robot& robot) const { return lasts() && task_->process->robot == &robot; }
  // The turn's thread has registered, so that it has a clock.
  bool HasClock() const { return lasts() && task_->slot >= 0; }

  // How far the thread may come, as its virtual CPU's time.
  VirtualTime horizon() const { return horizon_; }
  void LimitTo(VirtualTime horizon) { horizon_ = std::min(horizon_, horizon); }

  // Why the thread was stopped. In the first two cases the thread has said what it wants. In the
  // third its time was over, which is also so where it only has to be looked at; then it goes on.
  bool notified = false;
  std::optional<TrappedCall> trapped;
  bool timed_out = false;
  bool HasSpoken() const { return notified || trapped.has_value(); }

  bool is_sent_to_gate = false;    // whatever the thread says next is its stop
  bool goes_on_from_gate = false;  // where it had been told to go before
  int false_alarms = 0;            // of the detector, which shares the processor with the thread
  int held_looks = 0;              // since the thread was found blocked in the kernel
  std::uint64_t recorded_tsc = 0;  // up to here its slices have been recorded

 private:
  Task* task_ = nullptr;
  VirtualTime horizon_;
};

}  // namespace tcs
