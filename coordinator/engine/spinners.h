// Threads of ideal robots that compute at one instant without end: such threads have stepped aside,
// and look again once another thread has run.
#pragma once

#include "coordinator/engine/engine_part.h"
#include "coordinator/tasks/task.h"

namespace tcs {

class Spinners : public EnginePart {
 public:
  using EnginePart::EnginePart;

  // The thread has computed for long at one instant, and stops doing so unless it has said
  // something.
  void StepAside(Task& task);
  void Wake();
  bool any() const { return any_; }

 private:
  bool any_ = false;
};

}  // namespace tcs
