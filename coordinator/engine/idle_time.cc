#include "coordinator/engine/idle_time.h"

#include <algorithm>
#include <utility>

#include "coordinator/engine/wiring.h"
#include "coordinator/os/guardian.h"

namespace tcs {

namespace {

constexpr HostDuration kUnseenPoll = HostDuration::Milliseconds(1);
constexpr HostDuration kDebuggerPoll = HostDuration::Milliseconds(10);

constexpr HostDuration kOutsidePoll = HostDuration::Milliseconds(200);
constexpr int kAwaitTurns = 25;  // of kOutsidePoll

}  // namespace

void IdleTime::WaitOutside() {
  Beat();
  const bool unseen = run_.is_unprivileged || all_.waker.unseen() > 0 ||
                      all_.waker.counts().for_child() > 0 || all_.waker.counts().for_signals() > 0;
  all_.event_pump.Poll(unseen ? kUnseenPoll : kOutsidePoll, {run_.latest});
}

// No thread runs: an event that comes in meanwhile happens now.
void IdleTime::WaitForDebugger() {
  Beat();
  all_.event_pump.Poll(kDebuggerPoll, {run_.latest});
}

// Before idle time is jumped over: is something from outside already there?
bool IdleTime::HasJumpedOver() {
  const PollOutcome found = all_.event_pump.Poll(EventPump::kNoWait, {run_.latest});
  all_.unseen_threads.Poll();
  if (all_.unseen_threads.UnregisteredRun()) {
    all_.event_pump.Poll(kUnseenPoll, {run_.latest});
    return false;
  }
  return !found.wakes_others;
}

bool IdleTime::AwaitExits() {
  const auto is_dead = [this](const Process& process) {
    return process.dead || (process.robot->is_ours && !run_.IsInGrace());
  };
  for (int turn = 0; turn < kAwaitTurns && Living() == 0 && !all_.launches.AreAhead(); ++turn) {
    const bool all_dead =
        std::all_of(run_.table.processes().begin(), run_.table.processes().end(), is_dead);
    if (all_dead || all_.grace.IsOver() || (run_.stop.asked() && !run_.IsInGrace())) return false;
    all_.event_pump.Poll(kOutsidePoll, {run_.latest});
  }
  return Living() > 0 || all_.launches.AreAhead();
}

int IdleTime::Living() const {
  int living = run_.table.living();
  if (run_.IsInGrace()) return living;
  for (const Robot& robot : run_.robots) {
    if (robot.is_ours) living -= static_cast<int>(robot.tasks.size());
  }
  return living;
}

// No thread acts by itself any more, and no world goes on: the rest of the run is idle time, which
// is jumped over. But threads that the kernel has, or that compute without a call, may still come
// back: they get as much real time as there is virtual time left. False at the run's end.
bool IdleTime::AwaitOutside() {
  if (!run_.end.IsNever()) {
    const PollOutcome found = all_.event_pump.Poll(EventPump::kNoWait, {run_.latest});
    all_.unseen_threads.Poll();
    if (found.wakes_others || !run_.root.Least().IsNever()) return true;
    if (all_.waker.unseen() == 0 && !all_.spinners.any() &&
        !all_.unregistered_children.AnyCounts() && !all_.unseen_threads.UnregisteredRun())
      return false;
    const VirtualTime furthest = all_.world_leaf.FurthestOfRun();
    const HostTime now = all_.pacing.RunningTime();
    if (std::exchange(idle_at_, furthest) != furthest) idle_since_ = now;
    if ((now - idle_since_).ns() >= (run_.end - furthest).ns()) return false;
  }
  if (all_.spinners.any()) {
    all_.spinners.Wake();
  } else {
    WaitOutside();
  }
  return true;
}

}  // namespace tcs
