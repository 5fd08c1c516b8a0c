// The clock of one program: what its threads read, and what their deadlines and timers are given
// in. It is its robot's clock, except under --sync callback. There the world stands still while a
// program computes, and only the program's own clock goes on; while the program waits, the world
// catches up. The clock never goes back, nor behind the end of a wait that is over by time.
//
// The two kinds of time are different types (shm/time_kinds.h).
//
// Pure: makes no system call. Not thread-safe.
#pragma once

#include "shm/time_kinds.h"

namespace tcs {

class ProgramClock {
 public:
  ProgramClock() = default;

  // That of a child, which has held nobody up yet.
  ProgramClock Fork() const;

  // How far it is ahead of its robot's; else than under --sync callback always 0.
  VirtualDuration lead() const { return lead_; }
  // The furthest that it has come.
  ProgramTime shown() const { return shown_; }

  // What it shows when the robot's shows that, and the other way round; `lead`: with what it was
  // ahead by then, as for a thread that has waited since. Never stays so.
  ProgramTime At(VirtualTime robot) const { return At(robot, lead_); }
  static ProgramTime At(VirtualTime robot, VirtualDuration lead);
  VirtualTime RobotTimeOf(ProgramTime own) const;

  // Its program has come to that, by the end of a wait or a timer's expiry.
  void ComeTo(ProgramTime own);
  // The program goes on at that time of the robot's: for as long as it was ahead, its clock stood.
  void LetWorldCatchUp(VirtualTime robot);
  // The program has computed, or has shown so much of the time to come, all at one time of the
  // robot's.
  void Advance(VirtualTime robot, VirtualDuration by);

  // For how long it has held the world up at that time of the robot's, and that it did once more.
  VirtualDuration HeldAt(VirtualTime robot) const;
  void NoteHeld(VirtualTime robot, VirtualDuration by);

 private:
  VirtualDuration lead_;
  ProgramTime shown_;
  VirtualTime held_at_ = RobotTime(-1);
  VirtualDuration held_;  // there
};

}  // namespace tcs
