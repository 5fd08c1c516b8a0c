// When a run may act that is held to a pace, and to what people who watch ask of it: the arithmetic
// between the wall clock and virtual time.
//
// A run acts at one virtual time after the other, and asks before each: may it, or how long is it
// to wait? So it is only ever held back, in real time: what happens, and at which virtual time, is
// the same at any pace. Where it stands at a time, all has happened that happens until then.
//
// Pure: no system calls, reads no clock. `real_ns` is any clock of the host's that does not go
// back, the same in all calls; all other times are virtual nanoseconds where not said otherwise.
#pragma once

#include <cstdint>

namespace tcs {

class Pacer {
 public:
  // Later than this, of real time, the run is behind its pace.
  static constexpr std::int64_t kToleranceNs = 5'000'000;
  // What it is behind by it makes up for, but no more than this: people and devices beside it are
  // to see time pass at its pace, not faster for long.
  static constexpr std::int64_t kMostMadeUpNs = 100'000'000;
  static constexpr std::int64_t kForEver = INT64_MAX;

  // How the run has kept to its pace, in real nanoseconds.
  struct Account {
    std::int64_t behind_ns = 0;    // for how long it was behind, in all
    std::int64_t most_ns = 0;      // by how much at most, at one time
    std::int64_t given_up_ns = 0;  // what it will not make up for any more
    std::int64_t stood_ns = 0;     // for how long somebody let it stand
  };

  // Virtual seconds for each real one; 0: as fast as it can.
  Pacer(double pace, bool stands);

  // What people ask for. The run goes on from where it has come to.
  void SetPace(double pace, std::int64_t real_ns);
  void Stand(std::int64_t real_ns);
  void GoOn(std::int64_t real_ns);
  // Goes on for exactly so long from where it stands, or has come to, and stands then. Of steps
  // that are asked for before one is over each counts.
  void StepBy(std::int64_t ns, std::int64_t real_ns);

  // The run would act at `next_ns` next; not before what it was asked for earlier. Real nanoseconds
  // to wait before it asks again; 0: it may; kForEver: until somebody lets it go on.
  std::int64_t ToWait(std::int64_t next_ns, std::int64_t real_ns);

  // The time that the run has come to: that at which it stands, or that of the wall clock while it
  // waits.
  std::int64_t now_ns() const { return now_ns_; }
  double pace() const { return pace_; }
  // It waits for somebody to let it go on: as of the last ToWait.
  bool stands() const { return stands_; }
  // By how much, of real time, it is behind its pace: as of the last ToWait. Without what it gave
  // up.
  std::int64_t behind_ns() const { return behind_ns_; }
  const Account& account() const { return account_; }

 private:
  void StartFrom(std::int64_t real_ns);
  void TakeAccount(std::int64_t behind_ns, std::int64_t real_ns);

  double pace_;
  // Nothing happens later than this. Before the first step not even what happens at 0.
  std::int64_t limit_ns_;
  std::int64_t now_ns_ = 0;
  // At this real time the run was, or is to be, at this virtual one.
  bool has_origin_ = false;
  std::int64_t origin_real_ns_ = 0, origin_ns_ = 0;
  bool stands_ = false;
  std::int64_t behind_ns_ = 0, asked_real_ns_ = 0;
  Account account_;
};

}  // namespace tcs
