// When the run may act: at the pace that it is given, and as the people ask who watch it on its
// live page. Pacing only ever holds the run back, in real time. Without a pace and a page there is
// no pacing.
//
// For the coordinator's thread only.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "coordinator/policy/pacer.h"
#include "coordinator/tasks/coordinator.h"
#include "coordinator/tasks/run_clock.h"

namespace tcs {

class Pacing {
 public:
  // `notice` gets what people have to know at once.
  Pacing(const RunOptions& options, VirtualTime end,
         std::function<void(const std::string&)> notice);

  bool IsOn() const { return is_on_; }
  bool IsWatched() const { return view_ != nullptr; }

  // For how long the run, which acts at `next` next, is to wait before it asks again; 0: the run
  // may act now. At most kLook: people may ask for something meanwhile.
  static constexpr HostDuration kLook = HostDuration::Milliseconds(20);
  HostDuration ToWait(VirtualTime next);

  const Pacer& pacer() const { return pacer_; }
  // The run may act now, but others have its processor: it is held back until it is asked for again
  // how long it has to wait.
  void WaitForProcessor() { held_since_ = RunClock::Now(); }
  // Of the real time since the run began, for how long it was held back.
  HostDuration held() const { return held_; }
  // The host's time without the time held back: a thread that was held back is not to be taken for
  // standing still.
  HostTime RunningTime() const { return RunClock::Now() - held_; }
  PaceReport Report() const;

 private:
  void TakeControlRequests(HostTime now);
  void LookAtServer(HostTime now);

  Pacer pacer_;
  ViewLink* const view_;
  const VirtualTime end_;
  const std::function<void(const std::string&)> notice_;
  const bool is_on_;
  bool is_orphaned_ = false;  // the server has ended
  HostTime next_tell_;
  std::optional<HostTime> begun_, held_since_;
  HostDuration held_;
};

}  // namespace tcs
