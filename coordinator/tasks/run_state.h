// The data that the parts of a run share: the request, the threads and processes that take part,
// how far the run has come, and what it is to report. Plain data, and what follows from it alone;
// the parts change it.
//
// For the coordinator's thread only.
#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <string>
#include <vector>

#include "coordinator/os/stop_request.h"
#include "coordinator/policy/temporal_consistency.h"
#include "coordinator/scenario/scenario.h"
#include "coordinator/tasks/coordinator.h"
#include "coordinator/tasks/task_table.h"
#include "coordinator/tasks/turn.h"
#include "shm/layout.h"
#include "shm/time_kinds.h"

namespace tcs {

struct RunState {
  // Where each process has a broker there are only gates.
  RunState(const Scenario& its_scenario, const RunOptions& its_options, bool unprivileged,
           bool with_brokers = false);

  const Scenario scenario;
  const RunOptions options;
  const bool is_unprivileged;  // there is no right to real-time priorities, or it is not used
  const bool has_brokers;  // each process has one (os/descriptor_broker.h): pidfd_getfd is refused
  RunReport report;

  TaskTable table;
  std::deque<Robot> robots;
  std::deque<VirtualCpu> cpus;  // of all robots, by leaf
  TemporalConsistency root;
  Turn turn;
  double ticks_per_ns = 1.0;         // of the TSC
  shm::RunHeader* header = nullptr;  // which all clients can read; null before the set-up

  // How far CLOCK_REALTIME was ahead of virtual time at first, once a program has set the date.
  std::optional<std::int64_t> first_realtime_offset_ns;

  VirtualTime end;
  // When the last event has happened. Events from elsewhere happen then, too, while nobody acts.
  VirtualTime latest;
  VirtualDuration most_lead;              // of all programs' clocks
  bool had_unregistered_threads = false;  // some process, at some time
  // Threads that have made their last call, and that the kernel was not through with when they were
  // last looked at. The effects of their ends come late to others then, and time waits for them.
  std::vector<pid_t> exiting;
  StopRequest stop;
  VirtualTime grace_began = VirtualTime::Never();

  // How far CLOCK_REALTIME, or CLOCK_MONOTONIC, is ahead of virtual time.
  std::int64_t OffsetOf(bool is_real) const {
    return is_real ? header->realtime_offset_ns.load() : header->monotonic_offset_ns;
  }

  bool IsFixed() const { return options.accounting == shm::Accounting::kFixed; }
  bool IsCallback() const { return options.sync == shm::Sync::kCallback; }
  // Without levels a thread that computes is told by a signal to stop.
  bool Preempts() const { return is_unprivileged && !IsFixed(); }
  // Threads are told by a signal to go to their gates; with levels, those that are not dispatched.
  bool SendsToGates() const { return is_unprivileged || IsFixed(); }
  bool IsInGrace() const { return !grace_began.IsNever(); }

  // The thread is charged at once for the time that it has computed outside of a turn, and passes
  // that time in its turns. Returns the time as the host's.
  HostDuration ChargeAsDebt(Task& task, VirtualDuration computed);
  // The same, for what a thread has not computed, but would natively have. The thread is stopped.
  void ChargePrice(Task& task, VirtualDuration price);

  // The furthest that two leaves, or a program's clock and the world, have been apart.
  VirtualDuration Drift() const { return std::max(root.drift(), most_lead); }

  // Gives each warning once.
  void Warn(const std::string& text);

  // The virtual time of what the running thread has just done to others: the time that its clock
  // showed when it held for the write.
  VirtualTime WrittenAt() const;
  // The same for what the thread did when its clock had shown `shown`.
  VirtualTime WrittenAt(ProgramTime shown) const;
};

inline shm::ThreadSlot& SlotOf(const Task& task) { return *task.slot_memory; }

// The robot's scheduler, as far as it concerns a thread.
inline RobotScheduler& SchedulerOf(const Task& task) { return task.process->robot->scheduler; }
inline const SchedulingParameters& ParametersOf(const Task& task) {
  return SchedulerOf(task).ParametersOf(task.order);
}
inline RobotScheduler::Priority PriorityOf(const Task& task) {
  return SchedulerOf(task).PriorityOf(task.order);
}

}  // namespace tcs
