#include "coordinator/calls/timer_signals.h"

#include <signal.h>

#include <algorithm>

#include "coordinator/os/signal_bits.h"
#include "coordinator/port/proc_files.h"
#include "coordinator/port/thread_signals.h"
#include "coordinator/tasks/signal_sets.h"

namespace tcs {

namespace {

// Whether a thread with these sets would run a handler for the signal.
bool Handles(const Task& task, const SignalSets& sets, int signal) {
  return (sets.caught & ~BlockedOf(task, sets) & SignalBit(signal)) != 0;
}

void Send(Process& process, const TimerSignal& signal, pid_t tid) {
  if (signal.timer_id != 0) {
    process.timers.NoteSent(signal, tid);
    SendTimerSignal({.pid = process.pid,
                     .tid = tid,
                     .number = signal.number,
                     .timer_id = static_cast<int>(signal.timer_id),
                     .overruns = static_cast<int>(signal.overruns),
                     .value = signal.value});
  } else if (tid == 0 || process.threads == 1) {
    kill(process.pid, signal.number);
  } else {
    tgkill(process.pid, tid, signal.number);
  }
}

// Whether a signal of that number is pending.
bool MayBePending(const Process& process, const ProcessTimers::SentSignal& sent) {
  const SignalSets sets = ReadSignalSets(sent.to != 0 ? sent.to : process.pid);
  const std::uint64_t pending = sent.to != 0 ? sets.own_pending : sets.shared_pending;
  return (pending & SignalBit(sent.number)) != 0;
}

}  // namespace

// The thread that waits to accept the signal, 0 if there is none. The kernel, too, prefers that
// thread to others.
pid_t TimerSignals::AccepterOf(const Process& process, const TimerSignal& signal) {
  for (const Task* task : process.robot->tasks) {
    const auto* wait = task->Awaits<awaited::Signals>();
    if (wait == nullptr || task->process != &process) continue;
    if (signal.tid != 0 && task->tid != signal.tid) continue;
    if ((wait->set & SignalBit(signal.number)) != 0) return task->tid;
  }
  return 0;
}

// Null if no thread runs a handler, or only a thread that the kernel holds in a call. The kernel,
// too, gives the signal of a timer that has run out by computing to the thread that computes,
// before it asks other threads: a thread of lower priority might never come to its handler.
Task* TimerSignals::TakerOf(const Process& process, const TimerSignal& signal) const {
  Task* computed = signal.tid == 0 ? run_.table.Living(signal.computed) : nullptr;
  const auto handles = [&](Task* task) {
    return task != nullptr && task->slot >= 0 &&
           Handles(*task, SignalsOf(run_, *task), signal.number);
  };
  Task* taker = handles(computed) ? computed : nullptr;
  for (Task* task : process.robot->tasks) {
    if (taker != nullptr) break;
    if (task->process != &process || (signal.tid != 0 && task->tid != signal.tid)) continue;
    if (handles(task)) taker = task;
  }
  return taker == nullptr || taker->state == TaskState::kUnseen ? nullptr : taker;
}

bool TimerSignals::IsLost(const Process& process, int number, pid_t tid) const {
  Task* receiver = run_.table.Living(tid != 0 ? tid : process.pid);
  return receiver != nullptr && (LostOf(SignalsOf(run_, *receiver)) & SignalBit(number)) != 0;
}

void TimerSignals::Route(Process& process, EventTime when) {
  bool sent = false;
  for (TimerSignal& signal : process.timers.TakeSignals()) {
    if (signal.taker == 0 || run_.table.Living(signal.taker) == nullptr) {
      const pid_t accepter = AccepterOf(process, signal);
      Task* taker = accepter != 0 ? nullptr : TakerOf(process, signal);
      if (taker == nullptr) {
        const bool is_lost = accepter == 0 && IsLost(process, signal.number, signal.tid);
        Send(process, signal, accepter != 0 ? accepter : signal.tid);
        if (is_lost) process.timers.Lost(signal.timer_id);
        sent = true;
        continue;
      }
      signal.taker = taker->tid;
      if (taker->state == TaskState::kWaiting) {
        waker_.Wake(*taker, shm::WakeReason::kSignal, when);
      }
    }
    process.timers.GiveBack(signal);
    process.robot->keeps_timer_signals = true;
  }
  if (sent) wakes_.WakeForSignals(process, when);
}

void TimerSignals::SendTo(const Task& task) {
  Process& process = *task.process;
  if (!process.timers.HasSignals()) return;
  for (const TimerSignal& signal : process.timers.TakeSignals()) {
    if (signal.taker != 0 && signal.taker != task.tid) {
      process.timers.GiveBack(signal);
    } else {
      Send(process, signal, signal.taker);
    }
  }
}

void TimerSignals::NoteAccepted(Process& process, VirtualTime now) const {
  for (const ProcessTimers::SentSignal& sent : process.timers.SentSignals()) {
    if (MayBePending(process, sent)) continue;
    if (IsLost(process, sent.number, sent.to)) {
      process.timers.AcceptAt(sent.timer_id, now, false);
    } else {
      process.timers.Accept(sent.timer_id, now);
    }
  }
}

bool TimerSignals::IsPending(const Process& process, std::int64_t timer_id) {
  return std::ranges::any_of(process.timers.SentSignals(), [&](const auto& sent) {
    return sent.timer_id == timer_id && MayBePending(process, sent);
  });
}

}  // namespace tcs
