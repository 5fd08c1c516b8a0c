// The loop: advance what is due, choose the least advanced virtual CPU, let it act.
#pragma once

#include "coordinator/engine/engine_part.h"
#include "coordinator/tasks/task.h"

namespace tcs {

class Loop : public EnginePart {
 public:
  using EnginePart::EnginePart;

  // A step of the run; false at the run's end.
  bool Step();
  bool reached_end() const { return reached_end_; }

 private:
  void StepCpu(VirtualCpu& cpu);
  void PayDebt(Task& task, VirtualDuration passes);
  bool StandsForEver(VirtualCpu& cpu) const;
  void LetWorldGoOnWithout(Task& task);

  bool reached_end_ = false;
};

}  // namespace tcs
