// A turn of a thread, from its beginning to the answer to what the thread has said. While the turn
// lasts RunState::turn says what is known of it.
#pragma once

#include "coordinator/engine/engine_part.h"
#include "coordinator/tasks/event_time.h"
#include "coordinator/tasks/task.h"

namespace tcs {

class Dispatcher : public EnginePart {
 public:
  using EnginePart::EnginePart;

  // Runs the thread up to its horizon, charges it for what it did, and answers it. `idle_until`:
  // the thread may sleep that far without asking.
  void Dispatch(Task& task, VirtualTime horizon, VirtualTime idle_until);

  // The running thread has woken a thread of another computer, which does not need its core. The
  // running thread goes on, as far as the woken one now allows.
  void GoOnBesideWoken();
  void AnswerCall(Task& task);

  // The steps that turns have in common, wherever the thread has them (early_turns.h).
  static void NoteTurnBegins(Task& task);
  void EndTurn(Task& task);
  // Tells all who are concerned by how the turn has passed, whatever its thread wants now. The
  // thread's calls were made at `call`.
  void TellOthersOf(Task& task, EventTime call, bool looks_again);
  // Answers what the thread has said at the end of its turn.
  void Answer(Task& task);

 private:
  bool AnswerEarly(Task& task);
  void BeginTurn(Task& task, VirtualTime horizon, VirtualTime idle_until);
  void Resume(Task& task);
  void AwaitStop(Task& task);
  HostDuration TimeToLook(Task& task);
  ProgramTime OwnHorizon() const;
  bool HasMadeCall(Task& task, int* turns);
  bool GivesUpStart(Task& task, int turns);
  void ChargeSilence(Task& task);
  void LookForUntoldSignals(const Task& task, EventTime stop);
};

}  // namespace tcs
