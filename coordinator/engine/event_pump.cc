#include "coordinator/engine/event_pump.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "coordinator/engine/wiring.h"
#include "coordinator/port/clocks.h"

namespace tcs {

namespace {

constexpr int kMostFullTurns = 1000;  // a process that floods its pipe must not hold up all others

// How often a thread that the kernel holds is looked at.
constexpr HostDuration kHeldTurn = HostDuration::Microseconds(100);
// The same where another thread has the level of that one.
constexpr HostDuration kLentTurn = HostDuration::Microseconds(20);

// The detector's false alarms make it wait twice as long each time, up to 2^this times kHeldTurn.
constexpr int kMostFalseAlarms = 6;

}  // namespace

PollOutcome EventPump::Poll(HostDuration timeout, EventTime when) {
  PollOutcome found = LookOnce(timeout, when, false);
  for (int turn = 0; turn < kMostFullTurns; ++turn) {
    if (!std::exchange(found.looks_again, false) && !all_.reactor.IsFull()) break;
    found |= LookOnce(kNoWait, when, true);
  }
  return all_.gate_keeper.EndCall(found);
}

PollOutcome EventPump::LookOnce(HostDuration timeout, EventTime when, bool is_rest) {
  const bool held =
      run_.turn.held_looks > 0 && run_.turn.lasts() && !all_.host_cpu.detector().is_armed();
  const bool rearms =
      run_.turn.lasts() && run_.turn.false_alarms > 0 && !all_.host_cpu.detector().is_armed();
  const int doublings = held ? 0 : std::min(run_.turn.false_alarms, kMostFalseAlarms);
  const HostDuration turn =
      all_.host_cpu.active().is_lent() ? kLentTurn : kHeldTurn * (std::int64_t{1} << doublings);
  const bool is_cut_short = (held || rearms) && timeout > turn;
  if (is_cut_short) timeout = turn;
  const bool counts = !is_rest && run_.turn.HasClock() && timeout >= HostDuration();
  const shm::ClockReading before =
      counts ? all_.host_cpu.ClockOf(*run_.turn.task()) : shm::ClockReading{};
  const bool sleeps = timeout != HostDuration();
  if (sleeps && run_.turn.lasts()) {
    all_.state_link.Does(Doing::kAwaitsThread, all_.host_cpu.stop_tsc());
  } else if (sleeps) {
    all_.state_link.Does(Doing::kAwaitsEvents, HostTsc());
  }
  const std::size_t n = all_.reactor.Wait(timeout);
  if (!is_rest) all_.host_cpu.Woke();
  if (sleeps) all_.state_link.Does(Doing::kSchedules, all_.host_cpu.stop_tsc());
  if (n == 0 && is_rest) return {};
  if (counts) all_.settler.TakeOutUnaccounted(*run_.turn.task(), before, timeout);
  if (n == 0 && run_.turn.lasts()) {
    if (held || (rearms && is_cut_short)) {
      all_.host_cpu.active().TakeBack();
      if (held && run_.is_unprivileged) {
        // Other threads of the host may keep the processor from the detector for seconds. The
        // detector has said once that the kernel has the thread; whether the kernel still has it,
        // /proc says, too.
        ++run_.turn.held_looks;
        return {.stops_running = all_.block_detection.LetsOthersRun()};
      }
      all_.host_cpu.detector().Arm();
    } else {
      run_.turn.timed_out = true;
    }
    return {};
  }
  when = run_.turn.lasts() ? EventTime{run_.WrittenAt()} : all_.outside_leaf.WhenItCame(when);
  PollOutcome found = all_.reactor.Handle(when);
  found |= WakeReadyAwaiters(when);
  if (!run_.turn.lasts() || found.stops_running || !found.blocks_running) return found;
  ++run_.turn.held_looks;
  found.stops_running = all_.block_detection.LetsOthersRun();
  return found;
}

bool EventPump::PollWhileRunning(Task& task, HostDuration timeout) {
  while (all_.waker.counts().for_signals() + all_.waker.counts().for_stops() > 0 &&
         timeout > SignalCalls::kLookEvery) {
    if (Poll(SignalCalls::kLookEvery, {}).stops_running) return true;
    if (!run_.turn.timed_out) return false;
    run_.turn.timed_out = false;
    if (all_.signals.Poll()) return true;
    timeout -= SignalCalls::kLookEvery;
    all_.host_cpu.Continue(task);
  }
  return Poll(timeout, {}).stops_running;
}

// Wakes the threads whose descriptors have become ready, all at once: an event may be for one of
// these threads only.
PollOutcome EventPump::WakeReadyAwaiters(EventTime when) {
  std::vector<Task*> awaiters = std::exchange(ready_awaiters_, {});
  // Something else may have ended the wait meanwhile.
  std::erase_if(awaiters,
                [](const Task* task) { return task->Awaits<awaited::Descriptors>() == nullptr; });
  if (awaiters.empty()) return {};
  const bool beside = run_.turn.HasClock() &&
                      std::none_of(awaiters.begin(), awaiters.end(), [this](const Task* task) {
                        return run_.turn.IsOn(*task->process->robot);
                      });
  const bool passes_over = all_.shared_events.Wake(awaiters, when);
  if (beside) all_.dispatcher.GoOnBesideWoken();
  return {.stops_running = !beside, .wakes_others = true, .looks_again = passes_over};
}

}  // namespace tcs
