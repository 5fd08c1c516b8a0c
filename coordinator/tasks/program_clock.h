// The clock of one program: its threads read it, and their deadlines and timers are given in its
// time. It is the robot's clock, except under --sync callback. There the world stands still while a
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

  // The clock of a child, which has held nobody up yet.
  ProgramClock Fork() const;

  // How far the clock is ahead of its robot's; always 0 but under --sync callback.
  VirtualDuration lead() const { return lead_; }
  // The furthest time that the clock has come to.
  ProgramTime shown() const { return shown_; }

  // At: the time on this clock when the robot's shows `robot`; RobotTimeOf: the other way round.
  // `lead`: how far this clock was ahead then, as for a thread that has waited since. Never stays
  // so.
  ProgramTime At(VirtualTime robot) const { return At(robot, lead_); }
  static ProgramTime At(VirtualTime robot, VirtualDuration lead);
  VirtualTime RobotTimeOf(ProgramTime own) const;

  // The program has come to `own`, by the end of a wait or a timer's expiry.
  void ComeTo(ProgramTime own);
  // The program goes on at that time of the robot's: as long as its clock was ahead, it stood.
  void LetWorldCatchUp(VirtualTime robot);
  // The program has computed, or has shown so much of the time to come, all at one time of the
  // robot's.
  void Advance(VirtualTime robot, VirtualDuration by);

  // HeldAt: for how long the program has held the world up at that time of the robot's. NoteHeld:
  // the program has held it up once more.
  VirtualDuration HeldAt(VirtualTime robot) const;
  void NoteHeld(VirtualTime robot, VirtualDuration by);

 private:
  VirtualDuration lead_;
  ProgramTime shown_;
  VirtualTime held_at_ = RobotTime(-1);
  VirtualDuration held_;  // at held_at_
};

}  // namespace tcs
