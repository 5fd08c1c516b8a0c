#include "coordinator/engine/spinners.h"

#include <fmt/format.h>

#include "coordinator/engine/wiring.h"
#include "coordinator/scenario/patience.h"
#include "coordinator/text/spoken.h"

namespace tcs {

// On an ideal robot computing never takes time. The thread waits until another thread has run, and
// looks again, as long as it makes no call.
void Spinners::StepAside(Task& task) {
  if (run_.turn.HasSpoken() || task.state == TaskState::kDead) {
    task.spins = false;
    return;
  }
  run_.Warn(fmt::format(
      "{} has computed for {} at one instant of virtual time; its robot is ideal, so the world "
      "waits for it, but no longer than that; from here on it counts as waiting for other programs",
      task.process->name, Spoken(PatienceOf(run_.scenario).ideal.ns())));
  all_.waker.Wait(task, {awaited::OthersRun{}});
  any_ = true;
  all_.waker.Refresh(*task.process->robot);
}

void Spinners::Wake() {
  any_ = false;
  for (Task& task : run_.table.tasks()) {
    if (task.Awaits<awaited::OthersRun>() != nullptr) {
      all_.waker.Wake(task, shm::WakeReason::kGo, {run_.latest});
    }
  }
}

}  // namespace tcs
