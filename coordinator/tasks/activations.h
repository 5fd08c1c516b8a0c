// When the threads of a run were activated, and what each activation took (activations.csv,
// docs/RESULTS.md).
//
// An activation begins when a wait ends, and ends with the next wait. A thread that finds its next
// datagram there already never waits: what it receives begins the next one (shm/receipts.h). Works
// on the fields of a task that say so, and on what the thread's slot says of receipts. For the
// coordinator's thread only.
#pragma once

#include <cstdint>
#include <string>

#include "coordinator/tasks/task.h"
#include "coordinator/trace/activation_log.h"
#include "shm/layout.h"

namespace tcs {

class Activations {
 public:
  // `has_own_clocks`: a program's clock may be ahead of the world's (--sync callback).
  explicit Activations(bool has_own_clocks) : has_own_clocks_(has_own_clocks) {}

  // Empty on success, else one sentence.
  [[nodiscard]] std::string Open(const std::string& path, bool with_work) {
    return log_.Open(path, with_work);
  }
  void Flush() { log_.Flush(); }
  [[nodiscard]] std::string Close() { return log_.Close(); }

  // The thread's wait, which it is still in, ends for that reason. What was due before its robot
  // could look at it was due then.
  void Released(Task& task, shm::WakeReason reason, VirtualTime at) const;
  // It waits again, or has ended.
  void Idles(Task& task);
  // What it has received since its dispatch without having waited, up to `now` on its clock.
  void TakeReceipts(Task& task, ProgramTime now);
  // The same of a call that the kernel is to carry out, and that finds something there.
  void ReceivedRaw(Task& task, bool of_timer);

 private:
  void Next(Task& task, ProgramTime now, VirtualDuration charged, const shm::WorkCounts& work,
            bool of_timer);

  const bool has_own_clocks_;
  ActivationLog log_;
};

// What the thread has done according to `seen`, the shim's count of it.
inline shm::WorkCounts WithTrapped(const Task& task, const shm::WorkCounts& seen) {
  return {seen.calls + task.trapped_calls, seen.locks};
}

}  // namespace tcs
