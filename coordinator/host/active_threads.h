// Which threads may run on one processor of the host: the one that was dispatched last, which keeps
// that right until another one is dispatched or it is held; the one that it is lent to; and those
// that are to end.
//
// Each change costs a system call, so none is made that changes nothing. Threads are the caller's,
// who says when one has ended. For the coordinator's thread only.
#pragma once

#include <utility>

#include "coordinator/host/executor.h"
#include "coordinator/host/host_thread.h"

namespace tcs {

class ActiveThreads {
 public:
  explicit ActiveThreads(Executor& executor) : executor_(executor) {}

  // The thread is dispatched. The last one is held, unless it is at its gate: there it needs no
  // hold, and has the right already when it is dispatched next.
  void Dispatch(HostThread& thread) {
    if (last_ != &thread) HoldLast();
    if (!thread.may_run) LetRun(thread);
    last_ = &thread;
  }

  // Beside the one that was dispatched. Also of a thread of which it is not known what it may.
  void LetRun(HostThread& thread) {
    executor_.LetRun(thread.tid);
    thread.may_run = true;
  }

  void Hold(HostThread& thread) {
    if (thread.may_run) HoldUnknown(thread);
  }
  // One that the coordinator has just learnt of: it may what the one may that has made it.
  void HoldUnknown(HostThread& thread) {
    executor_.Hold(thread.tid);
    thread.may_run = false;
  }
  void LetKernelFinish(HostThread& thread) {
    executor_.LetKernelFinish(thread.tid);
    thread.may_run = false;
  }

  // To one thread at a time, which is held again by TakeBack.
  void Lend(HostThread& thread) {
    TakeBack();
    LetRun(thread);
    lent_ = &thread;
  }
  void TakeBack() {
    if (HostThread* thread = std::exchange(lent_, nullptr); thread != nullptr) Hold(*thread);
  }
  bool is_lent() const { return lent_ != nullptr; }

  // Who was dispatched last runs no more, where the coordinator is about to sleep.
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
