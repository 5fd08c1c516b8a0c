#include "coordinator/engine/block_detection.h"

#include <fmt/format.h>

#include <utility>

#include "coordinator/engine/wiring.h"
#include "coordinator/os/call_names.h"
#include "coordinator/port/proc_files.h"
#include "coordinator/port/waits.h"
#include "coordinator/tasks/cpu_clock.h"

namespace tcs {

namespace {

// After so many looks at a thread that the kernel holds, the kernel has held it for long.
constexpr int kLongHeldLooks = 10;
// For so many looks a world waits for such a thread.
constexpr int kHeldTurns = 200;
constexpr int kHeldTurnsFixed = 10'000;

// The threads of a process that ends as a whole have to be gone for so many looks, too.
constexpr int kExitTurns = 20;

}  // namespace

void BlockDetection::DetectorEnded() {
  all_.reactor.Remove(all_.host_cpu.detector().end_fd());
  if (run_.header->shutdown.load() == 0) run_.report.error = all_.host_cpu.detector().HowItEnded();
}

void BlockDetection::LookAtDetector() {
  if (all_.host_cpu.detector().IsDying()) DetectorEnded();
}

bool BlockDetection::LetsOthersRun() {
  // The thread waits for us. A thread that has spoken sleeps at its gate or in its call, and its
  // message may have been read in the look before this one.
  if (all_.gate_keeper.says_call() || run_.turn.HasSpoken()) return false;
  Task& task = *run_.turn.task();
  const char state = ThreadState(task.tid);
  if (run_.is_unprivileged && state == 'R') {
    // The detector, too, has had a moment of the processor beside the thread. The detector is armed
    // again soon.
    run_.turn.held_looks = 0;
    // Under set costs the detector is armed again when the coordinator looks at the thread. A
    // thread is found silent by how often it was looked at after an undisturbed while.
    if (run_.Preempts()) ++run_.turn.false_alarms;
    return false;
  }
  if (state != 'S' && task.process->threads > 1) all_.kernel_blocked.LetDie(*task.process);
  if ((state == 'Z' || state == 'X') && run_.turn.held_looks > kExitTurns &&
      KernelBlockedThreads::HasExited(task)) {
    all_.settler.Settle(task);
    all_.thread_exit.EndAndWake(task, {task.reached});
    return true;
  }
  // This process itself may have waited in the kernel for what /proc says, and the thread may have
  // gone on meanwhile, to its gate or to another call. Then the thread has said so.
  if (state == 'S' && all_.reactor.HasMore()) return false;
  // The thread has executed another program, has registered meanwhile and sleeps at its first gate,
  // to which it comes without a notification.
  if (state == 'S' && task.parked) return true;
  if (state == 'S' && CutsOff(task)) return task.process->violates_protocol;
  if (state == 't' && all_.debugger.IsOf(*task.process)) return false;  // and the whole run with it
  const auto in_call = state == 'S' || state == 'D'
                           ? all_.outside.LookIntoCall(task, HostNs(HostClockOf(task)))
                           : OutsideWaits::InCall::kNo;
  if (in_call == OutsideWaits::InCall::kMayWait) return false;
  const bool waits_outside = in_call == OutsideWaits::InCall::kWaits;
  const bool stopped = state == 'T' || state == 't';  // until a signal, or its tracer
  const bool in_vfork =
      state == 'D' && task.in_vfork && all_.spawns.HasMadeChild(task, {run_.WrittenAt()});
  if (!stopped && !in_vfork && !waits_outside && (state != 'S' || task.slot < 0)) {
    if (state == 'D') {
      all_.ahead.BringHomeHolders(*task.process, run_.turn.held_looks > kLongHeldLooks);
      all_.kernel_blocked.LendLevel();
    }
    return false;
  }
  // Where others would go on without the thread, it gets a moment to come back: the world must not
  // pass a program because of a short system call.
  const bool alone = task.process->threads == 1;
  const int turns = !alone                 ? 0
                    : run_.IsFixed()       ? kHeldTurnsFixed
                    : all_.world.present() ? kHeldTurns
                                           : 0;
  const bool expected = task.expects_kernel || waits_outside;
  if (!stopped && !expected && run_.turn.held_looks < turns) return false;
  all_.waker.SetState(task, TaskState::kUnseen);
  task.parked = false;
  if (expected && !stopped) return true;
  if (stopped) {
    const EventTime when{run_.WrittenAt()};
    all_.stops.Look(*task.process, when);
    all_.dds.NoteWhetherStopped(*task.process, when.at);
    return true;
  }
  run_.Warn(fmt::format(
      "{} blocked in {} of {}, a call that the shim does not know; that time is not charged",
      task.process->name, NameOfSystemCall(ThreadSystemCall(task.tid)),
      ProgramOf(task.process->pid)));
  return true;
}

// The running thread is at its gate, but its notification has not come: the thread's process has
// closed the pipe, or put another file in the pipe's place. The thread is told, and says so itself;
// or else the process is ended.
bool BlockDetection::CutsOff(Task& task) {
  if (task.slot < 0 || SlotOf(task).gate.load() != shm::kGateWaiting) return false;
  if (IsReadable(task.process->link->incoming_fd())) return false;
  if (std::exchange(task.is_cut_off, true)) {
    all_.violations.EndProcess(*task.process, "a notification that was never sent");
    return true;
  }
  shm::ThreadSlot& slot = SlotOf(task);
  run_.Warn(fmt::format(
      "thread {} of {} waits for the answer to a notification (kind {}) that has not arrived: its "
      "program has closed or replaced the connection; it is ended",
      task.tid, task.process->name, static_cast<int>(slot.note.kind)));
  slot.wake_reason.store(shm::WakeReason::kCutOff);
  all_.gate_keeper.OpenGate(task);
  run_.turn.held_looks = 0;
  all_.host_cpu.detector().Arm();
  return true;
}

}  // namespace tcs
