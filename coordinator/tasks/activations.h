// When the threads of a run were activated, and what each activation took (activations.csv,
// docs/RESULTS.md).
//
// An activation begins when a wait ends, and ends with the next wait. A thread that finds its next
// datagram there already never waits: the receipt begins the next activation (shm/receipts.h),
// which was released when the datagram arrived, as far as that is known (answers/answer_book.h).
// Works on the fields of a task that tell of activations, and on what the thread's slot says of
// receipts. For the coordinator's thread only.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>

#include "coordinator/tasks/answer_feed.h"
#include "coordinator/tasks/task.h"
#include "coordinator/trace/activation_log.h"
#include "shm/layout.h"

namespace tcs {

class Activations {
 public:
  // `has_own_clocks`: a program's clock may be ahead of the world's (--sync callback).
  explicit Activations(bool has_own_clocks) : has_own_clocks_(has_own_clocks) {}

  // The pause of a thread that begins to wait in the midst of its work; none: the work is done.
  using PauseOf = std::function<std::optional<AnswerBook::Pause>(const Task&)>;
  // `answers` is told of each activation that begins, pauses or ends; null: nobody is told.
  // `answers` outlives this.
  void Tell(AnswerFeed* answers, PauseOf pause_of) {
    answers_ = answers;
    pause_of_ = std::move(pause_of);
  }
  // Empty on success, else one sentence.
  [[nodiscard]] std::string Open(const std::string& path, bool with_work) {
    return log_.Open(path, with_work);
  }
  void Flush() { log_.Flush(); }
  [[nodiscard]] std::string Close() { return log_.Close(); }

  // The thread is there, for the first time.
  void Starts(const Task& task) const { TellOfBeginning(task, task.activation.release_ns); }
  // The thread's wait, which it is still in, ends for that reason. An event that was due before the
  // thread's robot could look at it counts from when it was due. The thread is ready `wakeup`
  // later.
  void Released(Task& task, shm::WakeReason reason, VirtualTime at, VirtualDuration wakeup) const;
  // The thread waits again, or dies.
  void Idles(Task& task, bool dies = false);
  // Takes note of what the thread has received since its dispatch without having waited, up to
  // `now` on its clock.
  void TakeReceipts(Task& task, ProgramTime now);
  // The same for a call that the kernel is to carry out, and that finds something there.
  void ReceivedRaw(Task& task, bool of_timer);
  // The run ends in the midst of the thread's activation.
  void IsCutOff(const Task& task, VirtualTime end) const;

 private:
  void FindRelease(Activation& activation, const Task& task, unsigned receipt) const;
  void TellOfEnd(const Task& task, unsigned receipt, std::int64_t end_ns,
                 std::int64_t charged_ns) const;
  bool TellOfPause(const Task& task, std::int64_t at_ns, std::int64_t charged_ns) const;
  void TellOfBeginning(const Task& task, std::int64_t at_ns) const;
  struct Receipt {
    unsigned number = 0;  // since the last stop, from 1 on; 0: none
    shm::Receipts::Of of = shm::Receipts::Of::kMessage;
    std::optional<std::int64_t> release_ns{};  // if the thread has told of it
  };
  void Write(const Task& task, const Activation& activation, std::int64_t end_ns,
             std::int64_t charged_ns, const shm::WorkCounts& work);
  void Next(Task& task, ProgramTime now, VirtualDuration charged, const shm::WorkCounts& work,
            const Receipt& receipt);

  const bool has_own_clocks_;
  AnswerFeed* answers_ = nullptr;
  PauseOf pause_of_;
  ActivationLog log_;
};

// The work that the thread has done according to `seen`, the shim's count of it.
inline shm::WorkCounts WithTrapped(const Task& task, const shm::WorkCounts& seen) {
  return {seen.calls + task.trapped_calls, seen.locks};
}

}  // namespace tcs
