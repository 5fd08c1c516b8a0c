// Tells a user who sees nothing happen, once: which programs the run waits for, and what for.
// Nothing of this changes what the run does.
//
// For the coordinator's thread only. Reads /proc when there is something to tell. Real nanoseconds
// where not said otherwise.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "coordinator/processes/unregistered_children.h"
#include "coordinator/processes/unregistered_threads.h"
#include "coordinator/tasks/run_state.h"

namespace tcs {

class StandstillWatch {
 public:
  // Shorter waits for what comes from outside are usual.
  static constexpr HostDuration kPatience = HostDuration::Seconds(5);
  // Of the time between two looks so much counts: the run itself may have had no processor.
  static constexpr HostDuration kMostBetweenLooks = HostDuration::Seconds(2);

  StandstillWatch(const RunState& run, const UnregisteredThreads& unregistered,
                  const UnregisteredChildren& unregistered_children)
      : run_(run), unregistered_(unregistered), unregistered_children_(unregistered_children) {}

  // `now` is the current time, and the furthest of all leaves has come to `furthest`. To be called
  // now and then. A notice goes to RunOptions::on_notice, which must be set.
  void Look(HostTime now, VirtualTime furthest);

 private:
  // The state that has not changed since.
  struct Standstill {
    std::int64_t dispatches = -1;
    VirtualTime furthest;
    HostTime looked_at;
    HostDuration stood;
  };

  void NoteStandstill(HostTime now, VirtualTime furthest);
  void NoteLeftBehind(HostTime now);
  bool AwaitsTerminal() const;
  std::vector<std::string> WhatIsAwaited() const;
  std::vector<std::string> WhatComputesUnregistered() const;

  const RunState& run_;
  const UnregisteredThreads& unregistered_;
  const UnregisteredChildren& unregistered_children_;
  Standstill standstill_;
  std::optional<HostTime> alone_since_;
  bool has_said_standstill_ = false, has_said_left_behind_ = false;
};

}  // namespace tcs
