// When a run may act that is held to a pace, and to what people who watch ask of it: the arithmetic
// between the wall clock and virtual time.
//
// A run acts at one virtual time after the other, and asks before each: may it, or how long is it
// to wait? So it is only ever held back, in real time: what happens, and at which virtual time, is
// the same at any pace. Where it stands at a time, all has happened that happens until then.
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
  // What it is behind by it makes up for, but no more than this: people and devices beside it are
  // to see time pass at its pace, not faster for long.
  static constexpr HostDuration kMostMadeUp = HostDuration::Milliseconds(100);
  static constexpr HostDuration kForEver = HostNs(INT64_MAX);
  // A run at a pace acts before the wall clock by up to this, so that an act that takes a few
  // milliseconds makes nothing late that follows it.
  static constexpr HostDuration kHeadStart = HostDuration::Milliseconds(4);

  // How the run has kept to its pace.
  struct Account {
    HostDuration behind;    // for how long it was behind, in all
    HostDuration most;      // by how much at most, at one time
    HostDuration given_up;  // what it will not make up for any more
    HostDuration stood;     // for how long somebody let it stand
  };

  // Virtual seconds for each real one; 0: as fast as it can.
  Pacer(double pace, bool stands);

  // What people ask for. The run goes on from where it has come to.
  void SetPace(double pace, HostTime real);
  void Stand(HostTime real);
  void GoOn(HostTime real);
  // Goes on for exactly so long from where it stands, or has come to, and stands then. Of steps
  // that are asked for before one is over each counts.
  void StepBy(VirtualDuration step, HostTime real);

  // The run would act at `next` next; not before what it was asked for earlier. For how long it is
  // to wait before it asks again; 0: it may act; kForEver: until somebody lets it go on.
  HostDuration ToWait(VirtualTime next, HostTime real);

  // The time that the run has come to: that at which it stands, or that of the wall clock while it
  // waits.
  VirtualTime now() const { return now_; }
  double pace() const { return pace_; }
  // It waits for somebody to let it go on: as of the last ToWait.
  bool stands() const { return stands_; }
  // By how much, of real time, it is behind its pace: as of the last ToWait. Without what it gave
  // up; 0 while it is ahead.
  HostDuration behind() const { return behind_; }
  const Account& account() const { return account_; }

 private:
  void StartFrom(HostTime real);
  void TakeAccount(HostDuration behind, HostTime real);

  double pace_;
  // Nothing happens later than this. Before the first step not even what happens at 0.
  VirtualTime limit_;
  VirtualTime now_;
  // At this real time the run was, or is to be, at this virtual one.
  bool has_origin_ = false;
  HostTime origin_real_;
  VirtualTime origin_;
  // Programs load at the run's start, which takes real time and next to no virtual one. What that
  // costs is no lateness: the wall clock counts from when the run waits for it first, or has tried
  // to for as long as it would make up for.
  bool is_loading_ = true;
  HostTime began_loading_;
  bool stands_ = false;
  HostDuration behind_;
  HostTime asked_real_;
  Account account_;
};

}  // namespace tcs
