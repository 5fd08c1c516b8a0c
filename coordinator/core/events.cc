// What the kernel says: notifications in the pipe, descriptors that clients wait for, commands,
// blocked threads, births and deaths.
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <sys/epoll.h>
#include <sys/signalfd.h>
#include <sys/wait.h>
#include <unistd.h>
#include <x86gprintrin.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "coordinator/core/engine.h"
#include "coordinator/os/call_names.h"
#include "coordinator/os/host.h"
#include "coordinator/tasks/cpu_clock.h"
#include "shm/attach_protocol.h"
#include "shm/clock_page.h"

namespace tcs {

namespace {

constexpr int kMostFullTurns = 1000;  // whoever floods its pipe must not hold up everybody
// How often a thread that the kernel holds is looked at, and for how long a world waits for it.
constexpr HostDuration kHeldTurn = HostDuration::Microseconds(100);
// Where another one has its level.
constexpr HostDuration kLentTurn = HostDuration::Microseconds(20);
// After so many such looks the kernel has held it for long.
constexpr int kLongHeldLooks = 10;
// The detector's false alarms make it wait twice as long each time, up to 2^this times kHeldTurn.
constexpr int kMostFalseAlarms = 6;
constexpr int kHeldTurns = 200;
constexpr int kHeldTurnsFixed = 10'000;
// So long the threads of a process that ends as a whole have to be gone, too.
constexpr int kExitTurns = 20;

}  // namespace

Reactor::Found Engine::NotificationArrived(Task& task, Moment moment) {
  task.executes = false;
  if (SlotOf(task).note.kind == shm::NotificationKind::kPreempted) task.has_signal = false;
  if (undispatched_.WentToGate(task)) return {};
  ahead_.HasSpoken(task);
  if (run_.turn.IsOf(task)) {
    if (run_.gates_only && MayGoOn(task)) return {.looks_again = true};
    run_.turn.notified = true;
  } else if (task.state == TaskState::kWaiting &&
             SlotOf(task).note.kind == shm::NotificationKind::kInterrupted) {
    waker_.Wake(task, shm::WakeReason::kSignal, moment);
    task.reply[0] = 1;
  } else if (task.state == TaskState::kUnseen) {
    ComeBack(task, moment);
    task.parked = true;
    host_cpu_.Check(task, CpuClockOf(task));
    const shm::Notification note = SlotOf(task).note;
    Reactor::Found found = kConcernsAll;
    found.looks_again = notifications_.Handle(task, note);
    return found;
  } else if (!task.parked || task.trap_id != 0) {
    // It ran on while the coordinator slept for a thread that the kernel held; or a signal from
    // outside has ended its trapped call.
    if (task.state == TaskState::kWaiting) waker_.Wake(task, shm::WakeReason::kSignal, moment);
    ChargeUndispatched(task);
    task.trap_id = 0;
    task.notified_early = true;
  } else if (SlotOf(task).note.kind == shm::NotificationKind::kInterrupted) {
    // The kernel let it run a handler before its turn, which is to answer what it said before.
    SlotOf(task).note.kind = shm::NotificationKind::kResumed;
  }
  return kConcernsAll;
}

bool Engine::PutOffArrival(Task& task) {
  return PutOff(&task, [this, &task, tid = task.tid](Moment at) {
    // It may have ended meanwhile.
    if (run_.table.Living(tid) != &task) return Reactor::Found{};
    task.is_put_off = false;
    return NotificationArrived(task, at);
  });
}

// Of one process, so many at a time: others have their turns, too.
Reactor::Found Engine::TakeNotifications(const Process& process, Moment moment) {
  constexpr std::size_t kAtOnce = 64;
  if (process.link == nullptr) return {};
  shm::PipeMessage messages[kAtOnce];
  const ssize_t bytes = read(process.link->incoming_fd(), messages, sizeof messages);
  const std::size_t count = bytes > 0 ? static_cast<std::size_t>(bytes) / sizeof messages[0] : 0;
  Reactor::Found found;
  for (std::size_t i = 0; i < count; ++i) {
    Task* task = process.link == nullptr ? nullptr : process.link->TaskAt(messages[i].slot);
    if (task == nullptr || task->state == TaskState::kDead) continue;
    if (IsSaidBeforeTurn(*task, messages[i])) continue;
    // One that says so again and again is heard once.
    if (!task->is_put_off && run_.gates_only) task->is_put_off = PutOffArrival(*task);
    if (!task->is_put_off) found |= NotificationArrived(*task, moment);
  }
  return found;
}

// Without it the first thread that waits in the kernel would make everybody wait with it.
void Engine::DetectorEnded() {
  reactor_.Remove(host_cpu_.detector().end_fd());
  if (run_.header->shutdown.load() == 0) run_.report.error = host_cpu_.detector().HowItEnded();
}

void Engine::LookAtDetector() {
  if (host_cpu_.detector().IsDying()) DetectorEnded();
}

// The running thread does not run. True if others get their turn; otherwise it is waited for: it is
// starting, or in the disk's hands, and its virtual CPU stands still until it goes on.
bool Engine::BlockedInKernel() {
  if (says_call_) return false;  // it waits for us
  Task& task = *run_.turn.task();
  const char state = ThreadState(task.tid);
  if (run_.gates_only && state == 'R') {
    // The detector, too, has had a moment of the processor beside it. It is armed again soon.
    run_.turn.held_looks = 0;
    // Under set costs it is armed again when the thread is looked at, which is found silent by how
    // often it was looked at after an undisturbed while.
    if (run_.Preempts()) ++run_.turn.false_alarms;
    return false;
  }
  if (state != 'S' && task.process->threads > 1) held_.LetDie(*task.process);
  if ((state == 'Z' || state == 'X') && run_.turn.held_looks > kExitTurns &&
      HeldThreads::HasExited(task)) {
    Settle(task);
    deaths_.EndAndWake(task, {task.reached});
    return true;
  }
  // This process may have waited in the kernel itself for what /proc says, and the thread gone on
  // meanwhile, to its gate or to another call. Then it has said so.
  if (state == 'S' && reactor_.HasMore()) return false;
  // It has executed another program, has registered meanwhile and sleeps at its first gate, to
  // which it comes without a notification.
  if (state == 'S' && task.parked) return true;
  if (state == 'S' && CutsOff(task)) return task.process->expelled;
  if (state == 't' && debugger_.IsOf(*task.process)) return false;  // and everybody with it
  const auto in_call = state == 'S' || state == 'D'
                           ? outside_.LookIntoCall(task, HostNs(HostClockOf(task)))
                           : OutsideWaits::InCall::kNo;
  if (in_call == OutsideWaits::InCall::kMayWait) return false;
  const bool waits_outside = in_call == OutsideWaits::InCall::kWaits;
  const bool stopped = state == 'T' || state == 't';  // until a signal, or its tracer
  const bool in_vfork =
      state == 'D' && task.in_vfork && spawns_.HasMadeChild(task, {run_.WrittenAt()});
  if (!stopped && !in_vfork && !waits_outside && (state != 'S' || task.slot < 0)) {
    if (state == 'D') {
      ahead_.BringHomeHolders(*task.process, run_.turn.held_looks > kLongHeldLooks);
      held_.LendLevel();
    }
    return false;
  }
  // Where others would go on without it, it gets a moment to come back: the world must not pass a
  // program because of a short system call.
  const bool alone = task.process->threads == 1;
  const int turns = !alone             ? 0
                    : run_.IsFixed()   ? kHeldTurnsFixed
                    : world_.present() ? kHeldTurns
                                       : 0;
  const bool expected = task.expects_kernel || waits_outside;
  if (!stopped && !expected && run_.turn.held_looks < turns) return false;
  waker_.SetState(task, TaskState::kUnseen);
  task.parked = false;
  if (expected && !stopped) return true;
  if (stopped) {
    const Moment moment{run_.WrittenAt()};
    stops_.Look(*task.process, moment);
    dds_.NoteWhetherStopped(*task.process, moment.at);
    return true;
  }
  run_.Warn(fmt::format(
      "{} blocked in {} of {}, a call that the shim does not know; that time is not charged",
      task.process->name, NameOfSystemCall(ThreadSystemCall(task.tid)),
      ProgramOf(task.process->pid)));
  return true;
}

// The running thread is at its gate, but its notification has not come: its process has closed the
// pipe, or put another file in its place. It is told, and says so itself; or else is ended.
bool Engine::CutsOff(Task& task) {
  if (task.slot < 0 || SlotOf(task).gate.load() != shm::kGateWaiting) return false;
  pollfd incoming{task.process->link->incoming_fd(), POLLIN, 0};
  if (poll(&incoming, 1, 0) != 0) return false;
  if (std::exchange(task.is_cut_off, true)) {
    expulsion_.Expel(*task.process, "a notification that was never sent");
    return true;
  }
  shm::ThreadSlot& slot = SlotOf(task);
  run_.Warn(fmt::format(
      "thread {} of {} waits for the answer to a notification (kind {}) that has not arrived: its "
      "program has closed or replaced the connection; it is ended",
      task.tid, task.process->name, static_cast<int>(slot.note.kind)));
  slot.wake_reason.store(shm::WakeReason::kCutOff);
  OpenGate(task);
  run_.turn.held_looks = 0;
  host_cpu_.detector().Arm();
  return true;
}

// All that there is at this instant: were the rest found later, it would have happened later.
Reactor::Found Engine::PollEvents(HostDuration timeout, Moment moment) {
  Reactor::Found found = TakeEvents(timeout, moment, false);
  for (int turn = 0; turn < kMostFullTurns; ++turn) {
    if (!std::exchange(found.looks_again, false) && !reactor_.IsFull()) break;
    found |= TakeEvents(kNoWait, moment, true);
  }
  return EndCall(found);
}

// `is_rest`: a further look at an instant, at which the running thread stands as it was found.
Reactor::Found Engine::TakeEvents(HostDuration timeout, Moment moment, bool is_rest) {
  const bool held =
      run_.turn.held_looks > 0 && run_.turn.lasts() && !host_cpu_.detector().is_armed();
  const bool rearms =
      run_.turn.lasts() && run_.turn.false_alarms > 0 && !host_cpu_.detector().is_armed();
  const int doublings = held ? 0 : std::min(run_.turn.false_alarms, kMostFalseAlarms);
  const HostDuration turn =
      host_cpu_.active().is_lent() ? kLentTurn : kHeldTurn * (std::int64_t{1} << doublings);
  const bool is_cut_short = (held || rearms) && timeout > turn;
  if (is_cut_short) timeout = turn;
  const bool counts = !is_rest && run_.turn.HasClock() && timeout >= HostDuration();
  const shm::ClockReading before =
      counts ? host_cpu_.ClockOf(*run_.turn.task()) : shm::ClockReading{};
  const bool sleeps = timeout != HostDuration();
  if (sleeps && run_.turn.lasts()) {
    state_link_.Does(Doing::kAwaitsThread, host_cpu_.stop_tsc());
  } else if (sleeps) {
    state_link_.Does(Doing::kAwaitsEvents, __rdtsc());
  }
  const std::size_t n = reactor_.Wait(timeout);
  if (!is_rest) host_cpu_.Woke();
  if (sleeps) state_link_.Does(Doing::kSchedules, host_cpu_.stop_tsc());
  if (n == 0 && is_rest) return {};
  if (counts) TakeOutUntold(*run_.turn.task(), before, timeout);
  if (n == 0 && run_.turn.lasts()) {
    if (held || (rearms && is_cut_short)) {
      host_cpu_.active().TakeBack();
      if (held && run_.gates_only) {
        // Others of the host may keep the processor from the detector for seconds. That the kernel
        // has the thread it has said once; whether it still has, /proc says, too.
        ++run_.turn.held_looks;
        return {.stops_running = BlockedInKernel()};
      }
      host_cpu_.detector().Arm();
    } else {
      run_.turn.timed_out = true;
    }
    return {};
  }
  moment = run_.turn.lasts() ? Moment{run_.WrittenAt()} : WhenItCame(moment);
  Reactor::Found found = reactor_.Handle(moment);
  found |= WakeReadyAwaiters(moment);
  if (!run_.turn.lasts() || found.stops_running || !found.blocks_running) return found;
  ++run_.turn.held_looks;
  found.stops_running = BlockedInKernel();
  return found;
}

// PollEvents for the running thread, in turns while somebody waits for signals.
bool Engine::PollWhileRunning(Task& task, HostDuration timeout) {
  while (waker_.counts().for_signals() + waker_.counts().for_stops() > 0 &&
         timeout > SignalCalls::kLookEvery) {
    if (PollEvents(SignalCalls::kLookEvery, {}).stops_running) return true;
    if (!run_.turn.timed_out) return false;
    run_.turn.timed_out = false;
    if (signals_.Poll()) return true;
    timeout -= SignalCalls::kLookEvery;
    host_cpu_.Continue(task);
  }
  return PollEvents(timeout, {}).stops_running;
}

// Those whose descriptors have become ready, all at once: one event may be for one of them only.
Reactor::Found Engine::WakeReadyAwaiters(Moment moment) {
  std::vector<Task*> awaiters = std::exchange(ready_awaiters_, {});
  // Something else may have ended the wait meanwhile.
  std::erase_if(awaiters,
                [](const Task* task) { return task->Awaits<awaited::Descriptors>() == nullptr; });
  if (awaiters.empty()) return {};
  const bool beside = run_.turn.HasClock() &&
                      std::none_of(awaiters.begin(), awaiters.end(), [this](const Task* task) {
                        return run_.turn.IsOn(*task->process->robot);
                      });
  const bool passes_over = shared_events_.Wake(awaiters, moment);
  if (beside) GoOnBesideWoken();
  return {.stops_running = !beside, .wakes_others = true, .looks_again = passes_over};
}

}  // namespace tcs
