#include "coordinator/tasks/program_clock.h"

#include <algorithm>

namespace tcs {

ProgramClock ProgramClock::Fork() const {
  ProgramClock child;
  child.lead_ = lead_;
  child.shown_ = shown_;
  return child;
}

ProgramTime ProgramClock::At(VirtualTime robot, VirtualDuration lead) {
  return OwnTimeOf(robot, lead);
}

VirtualTime ProgramClock::RobotTimeOf(ProgramTime own) const {
  return tcs::RobotTimeOf(own, lead_);
}

void ProgramClock::ComeTo(ProgramTime own) { shown_ = std::max(shown_, own); }

void ProgramClock::LetWorldCatchUp(VirtualTime robot) {
  lead_ = std::max(VirtualDuration(), RobotTime(shown_.ns()) - robot);
}

void ProgramClock::Advance(VirtualTime robot, VirtualDuration by) {
  lead_ += by;
  ComeTo(At(robot));
}

VirtualDuration ProgramClock::HeldAt(VirtualTime robot) const {
  return held_at_ == robot ? held_ : VirtualDuration();
}

void ProgramClock::NoteHeld(VirtualTime robot, VirtualDuration by) {
  held_ = HeldAt(robot) + by;
  held_at_ = robot;
}

}  // namespace tcs
