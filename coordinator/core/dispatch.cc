// Running one thread up to its horizon, and charging it for what it did.
#include <linux/futex.h>
#include <signal.h>
#include <sys/syscall.h>
#include <sys/timerfd.h>
#include <unistd.h>
#include <x86intrin.h>

#include <algorithm>

#include "coordinator/core/engine.h"
#include "shm/clock_page.h"

namespace tcs {

namespace {

constexpr std::int64_t kTimerLatenessNs = 20'000;
constexpr std::int64_t kCheckAfterNs = 100'000;
constexpr int kStartTurnsOfOneSecond = 30;

}  // namespace

void Engine::WritePage(Task& task, std::int64_t horizon_ns, std::int64_t idle_until_ns) {
  shm::ThreadSlot& slot = Slot(task);
  shm::ClockPage& page = slot.clock;
  const bool fixed = options_.accounting == shm::Accounting::kFixed;
  if (task.host_origin_ns < 0)
    task.host_origin_ns = ThreadCpuClockNs(task.tid, task.process->threads == 1);
  page.base_time_ns = task.cpu->progress_ns + task.debt_ns;
  page.base_cpu_ns = task.charged_ns;
  page.horizon_ns = horizon_ns;
  page.idle_until_ns = idle_until_ns;
  page.read_safe_ns = ReadSafe(*task.cpu);
  page.write_safe_ns = OthersNext(*task.cpu);
  page.host_cpu_origin_ns = task.host_origin_ns;
  page.ns_per_host_ns_q32 = static_cast<std::uint64_t>(4294967296.0 / task.cpu->speed);
  page.ns_per_tick_q32 =
      fixed ? 0
            : static_cast<std::uint64_t>(static_cast<double>(ns_per_tick_q32_) / task.cpu->speed);
  page.check_after_ticks =
      fixed ? ~std::uint64_t{0}
            : (static_cast<std::uint64_t>(kCheckAfterNs) << 32) / ns_per_tick_q32_;
  page.call_cost_ns = fixed ? task.process->call_cost_ns : 0;
  page.other_cpu_ns = task.process->ended_cpu_ns;
  page.children_cpu_ns = task.process->children_cpu_ns;
  const std::int64_t last = page.last_shown_ns.load();
  page.last_shown_ns.store(std::max(last, task.cpu->progress_ns));
  slot.core = task.cpu->core;
  slot.reply[0] = task.reply[0];
  slot.reply[1] = task.reply[1];
  slot.wake_reason.store(task.reason);
  ++task.dispatches;
  const std::uint64_t number = task.dispatches << shm::kAdjustBits;
  page.base_tsc = __rdtsc();
  page.executed_adjust.store(number);
  page.waited_adjust.store(number);
}

void Engine::Resume(Task& task) {
  if (last_ != nullptr && last_ != &task && last_->state != TaskState::kDead && !last_->parked &&
      last_->level != Level::kWaiting) {
    SetLevel(last_->tid, Level::kWaiting);
    last_->level = Level::kWaiting;
  }
  if (task.level != Level::kActive) {
    SetLevel(task.tid, Level::kActive);
    task.level = Level::kActive;
  }
  last_ = &task;
  if (task.slot >= 0 && task.parked) {
    std::atomic<std::uint32_t>& gate = Slot(task).gate;
    if (gate.exchange(shm::kGateOpen) == shm::kGateWaiting) {
      syscall(SYS_futex, &gate, FUTEX_WAKE, 1, nullptr, nullptr, 0);
    }
  }
  task.parked = false;
  if (!detector_armed_) {
    const std::uint64_t one = 1;
    detector_armed_ = write(detector_arm_, &one, sizeof one) == sizeof one;
  }
}

void Engine::ArmPreemption(const Task& task) {
  itimerspec spec{};
  if (task.slot < 0) {
    spec.it_value.tv_sec = 1;
  } else if (options_.accounting == shm::Accounting::kFixed) {
    spec.it_value.tv_sec =
        1;  // nothing to preempt for; only the watch over a thread that never calls
  } else {
    const double left =
        static_cast<double>(running_horizon_ns_ - task.cpu->progress_ns - task.debt_ns) *
        task.cpu->speed;
    const auto ns = std::max<std::int64_t>(
        5'000, static_cast<std::int64_t>(std::min(left, 1e9)) - kTimerLatenessNs);
    spec.it_value = timespec{ns / 1'000'000'000, ns % 1'000'000'000};
  }
  timerfd_settime(timer_, 0, &spec, nullptr);
}

void Engine::CheckCpuClock(Task& task) {
  if (options_.accounting == shm::Accounting::kFixed) return;
  shm::ClockPage& page = Slot(task).clock;
  const shm::ClockReading reading = shm::ReadClock(page);
  const std::int64_t cpu = ThreadCpuClockNs(task.tid, task.process->threads == 1);
  if (cpu >= 0) shm::RemoveStolen(page, reading, cpu);
}

std::int64_t Engine::RunningNow() {
  if (running_ == nullptr || running_->slot < 0) return event_ns_;
  const shm::ClockPage& page = Slot(*running_).clock;
  return std::max(running_->cpu->progress_ns, shm::ShownTime(page, shm::ReadClock(page)));
}

bool Engine::ReachedHorizon(Task& task) {
  shm::ClockPage& page = Slot(task).clock;
  if (shm::ReadClock(page).tsc - page.last_check_tsc.load() > page.check_after_ticks) {
    CheckCpuClock(task);
  }
  return shm::ReadClock(page).time_ns >= running_horizon_ns_ - kTimerLatenessNs;
}

void Engine::Settle(Task& task) {
  if (task.slot < 0) return;
  shm::ThreadSlot& slot = Slot(task);
  shm::ClockPage& page = slot.clock;
  if (shm::ReadClock(page).tsc - page.last_check_tsc.load() > page.check_after_ticks) {
    CheckCpuClock(task);
  }
  const shm::ClockReading reading = shm::ReadClock(page);
  const std::int64_t start = task.cpu->progress_ns;
  std::int64_t reached = reading.time_ns;
  // What the notification itself takes is ours, not the client's.
  if (notified_) reached = std::min(reached, std::max(slot.note.time_ns, start));
  if (notified_ && slot.note.time_ns >= running_horizon_ns_) reached = reading.time_ns;
  const std::int64_t executed = std::max<std::int64_t>(0, reading.cpu_ns - task.charged_ns);
  client_host_ns_ += static_cast<std::int64_t>(static_cast<double>(executed) * task.cpu->speed);
  task.charged_ns = reading.cpu_ns;
  std::int64_t progress = std::clamp(reached, start, std::max(start, running_horizon_ns_));
  // Stopped a little early for its horizon: the rest is credit.
  if (preempted_ && !notified_ && running_horizon_ns_ - progress <= kTimerLatenessNs) {
    progress = std::max(progress, running_horizon_ns_);
  }
  task.debt_ns = reached - progress;
  if (task.debt_ns < -kTimerLatenessNs) task.debt_ns = 0;
  task.cpu->progress_ns = progress;
}

void Engine::Dispatch(Task& task, std::int64_t horizon_ns, std::int64_t idle_until_ns) {
  if (task.notified_early) {
    task.notified_early = false;
    task.parked = true;
    task.state = TaskState::kReady;
    task.reply[0] = task.reply[1] = 0;
    const shm::Notification early = Slot(task).note;
    Handle(task, early);
    return;
  }
  running_ = &task;
  running_horizon_ns_ = horizon_ns;
  notified_ = preempted_ = false;
  if (task.state == TaskState::kHolding) task.state = TaskState::kReady;
  if (task.process->alarm_pending && task.slot >= 0) {
    task.process->alarm_pending = false;
    kill(task.process->pid, SIGALRM);
  }
  if (task.slot >= 0) WritePage(task, horizon_ns, idle_until_ns);
  ArmPreemption(task);
  Resume(task);
  ++report_.switches;
  int starting_turns = 0;
  while (!PollEvents(-1)) {
    if (task.slot < 0 && preempted_) {
      preempted_ = false;
      if (++starting_turns == kStartTurnsOfOneSecond) {
        report_.error =
            task.process->name +
            " did not load the shim within 30 s; is it dynamically linked, and not set-uid?";
        break;
      }
    }
    ArmPreemption(task);
  }
  if (task.state != TaskState::kDead) Settle(task);
  running_ = nullptr;
  event_ns_ = task.cpu->progress_ns;
  if (notified_ && task.state != TaskState::kDead) {
    task.parked = true;
    task.reply[0] = task.reply[1] = 0;
    const shm::Notification note = Slot(task).note;
    Handle(task, note);
  }
}

}  // namespace tcs
