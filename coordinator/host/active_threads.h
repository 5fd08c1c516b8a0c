// Which threads may run on one processor of the host: the thread that was dispatched last, which
// keeps that right until another thread is dispatched or it is held; the thread to which the
// processor is lent; and the threads that are to end.
//
// Each change costs a system call, so this class makes no change that changes nothing. The threads
// belong to the caller, who says when one of them has ended. For the coordinator's thread only.
#pragma once

#include <utility>

#include "coordinator/host/executor.h"
#include "coordinator/host/host_thread.h"

namespace tcs {

class ActiveThreads {
 public:
  explicit ActiveThreads(Executor& executor) : executor_(executor) {}

  // The thread is dispatched. The thread before it is held, unless that thread is at its gate:
  // there it needs no hold, and it has the right already at its next dispatch.
  void Dispatch(HostThread& thread) {
    if (last_ != &thread) HoldLast();
    if (!thread.may_run) LetRun(thread);
    last_ = &thread;
  }

  // Lets the thread run beside the dispatched one. Also for a thread of which it is not known
  // whether it may run.
  void LetRun(HostThread& thread) {
    executor_.LetRun(thread.tid);
    thread.may_run = true;
  }

  void Hold(HostThread& thread) {
    if (thread.may_run) HoldUnknown(thread);
  }
  // For a thread of which the coordinator has just learnt: it may run if the thread that created it
  // may run.
  void HoldUnknown(HostThread& thread) {
    executor_.Hold(thread.tid);
    thread.may_run = false;
  }
  void LetKernelFinish(HostThread& thread) {
    executor_.LetKernelFinish(thread.tid);
    thread.may_run = false;
  }

  // Lends the processor to one thread at a time, which is held again by TakeBack.
  void Lend(HostThread& thread) {
    TakeBack();
    LetRun(thread);
    lent_ = &thread;
  }
  void TakeBack() {
    if (HostThread* thread = std::exchange(lent_, nullptr); thread != nullptr) Hold(*thread);
  }
  bool is_lent() const { return lent_ != nullptr; }

  // The thread that was dispatched last does not run any more, where the coordinator is about to
  // sleep.
  void HoldLast() {
    if (last_ != nullptr && !last_->parked) Hold(*last_);
  }

  bool IsLast(const HostThread& thread) const { return &thread == last_; }
  void Ended(const HostThread& thread) {
    if (last_ == &thread) last_ = nullptr;
    if (lent_ == &thread) lent_ = nullptr;
  }

 private:
  Executor& executor_;
  HostThread* last_ = nullptr;
  HostThread* lent_ = nullptr;
};

}  // namespace tcs
