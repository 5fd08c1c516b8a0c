// When a run may act that is held to a pace, and to what people who watch ask of it: the arithmetic
// between the wall clock and virtual time.
//
// A run acts at one virtual time after the other, and asks before each: may it, or how long is it
// to wait? So it is only ever held back, in real time: events and their virtual times are the same
// at any pace. Where the run stands at a time, all events until then have happened.
//
// Pure: no system calls, reads no clock. A HostTime is of any clock of the host's that does not go
// back, the same in all calls.
#pragma once

#include "shm/time_kinds.h"

namespace tcs {

class Pacer {
 public:
  // Later than this the run is behind its pace.
  static constexpr HostDuration kTolerance = HostDuration::Milliseconds(5);
  // The run makes up for the time by which it is behind, but for no more than this: people and
  // devices beside it are to see time pass at its pace, not faster for long.
  static constexpr HostDuration kMostMadeUp = HostDuration::Milliseconds(100);
  static constexpr HostDuration kForEver = HostNs(INT64_MAX);
  // A run at a pace acts before the wall clock by up to this, so that an act that takes a few
  // milliseconds makes nothing late that follows it.
  static constexpr HostDuration kHeadStart = HostDuration::Milliseconds(4);

  // How the run has kept to its pace.
  struct Account {
    HostDuration behind;    // for how long it was behind, in all
    HostDuration most;      // by how much at most, at one time
    HostDuration given_up;  // the time that it will not make up for any more
    HostDuration stood;     // for how long somebody let it stand
  };

  // Virtual seconds for each real one; 0: as fast as it can.
  Pacer(double pace, bool stands);

  // Requests of people. The run goes on from where it has come to.
  void SetPace(double pace, HostTime real);
  void Stand(HostTime real);
  void GoOn(HostTime real);
  // The run goes on for exactly `step` from where it stands, or has come to, and stands then. Steps
  // that are asked for before one is over count, too.
  void StepBy(VirtualDuration step, HostTime real);

  // The run would act at `next` next; not before what it was asked for earlier. Returns how long
  // the run is to wait before it asks again; 0: it may act; kForEver: until somebody lets it go on.
  HostDuration ToWait(VirtualTime next, HostTime real);

  // The time that the run has come to: the time at which it stands, or the wall clock's while it
  // waits.
  VirtualTime now() const { return now_; }
  double pace() const { return pace_; }
  // The run waits for somebody to let it go on: as of the last ToWait.
  bool stands() const { return stands_; }
  // The real time by which the run is behind its pace: as of the last ToWait. Without the time that
  // it gave up; 0 while it is ahead.
  HostDuration behind() const { return behind_; }
  const Account& account() const { return account_; }

 private:
  void StartFrom(HostTime real);
  void TakeAccount(HostDuration behind, HostTime real);

  double pace_;
  // No event happens later than this. Before the first step not even events at 0 happen.
  VirtualTime limit_;
  VirtualTime now_;
  // At this real time the run was, or is to be, at this virtual one.
  bool has_origin_ = false;
  HostTime origin_real_;
  VirtualTime origin_;
  // Programs load at the run's start, which takes real time and next to no virtual one. The time of
  // loading is no lateness: the wall clock counts from when the run waits for it first, or has
  // tried to for as long as it would make up for.
  bool is_loading_ = true;
  HostTime began_loading_;
  bool stands_ = false;
  HostDuration behind_;
  HostTime asked_real_;
  Account account_;
};

}  // namespace tcs
