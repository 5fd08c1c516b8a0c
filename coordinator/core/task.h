// The coordinator's own idea of threads, processes and virtual CPUs. Nothing here is shared with
// clients.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "coordinator/os/host.h"
#include "shm/layout.h"
#include "shm/virtual_time.h"

namespace tcs {

enum class TaskState {
  kStarting,  // not attached yet                     -> kReady by its attach
  kReady,     // wants its virtual CPU                -> running, by dispatch
  kHolding,   // wants it once a time is safe         -> kReady by the progress of others
  kWaiting,   // for a deadline, descriptors, a child -> kReady by what it waits for, or a signal
  kUnseen,  // blocked in a call the shim cannot see -> kReady once the kernel has it runnable again
  kDead,
};

struct Process;
struct VirtualCpu;

struct Task {
  Process* process = nullptr;
  VirtualCpu* cpu = nullptr;
  pid_t tid = 0;
  int slot = -1;
  int order = 0;  // of registration; breaks ties
  int priority = 0;
  TaskState state = TaskState::kStarting;
  shm::NotificationKind hold = shm::NotificationKind::kNone;  // kRead or kWrite while kHolding
  std::int64_t deadline_ns = shm::kNeverNs;
  bool waits_for_fds = false, waits_for_child = false;
  std::vector<int> watched;  // descriptors in the coordinator's epoll set
  shm::WakeReason reason = shm::WakeReason::kGo;
  std::int64_t reply[2] = {0, 0};
  std::uint64_t ready_number = 0;  // first ready, first served among equals
  std::int64_t debt_ns = 0;        // executed beyond a horizon, charged first at the next dispatch
  std::int64_t charged_ns = 0;
  std::int64_t host_origin_ns = -1;
  std::int64_t host_cpu_ns = -1;  // used in the run, by the thread's own clock; -1: it ended before
  std::uint64_t dispatches = 0;
  bool parked = true;           // at its gate, rather than stopped by priority
  bool notified_early = false;  // has notified without being dispatched: answered at its dispatch
  Level level = Level::kWaiting;
  std::int64_t activations = 0;
};

struct Timer {
  std::int64_t next_ns = 0, interval_ns = 0;
  int event_fd = -1;  // -1: ITIMER_REAL, a SIGALRM
};

struct Process {
  pid_t pid = 0, parent = 0;
  int pidfd = -1;
  VirtualCpu* cpu = nullptr;
  std::string name;
  int priority = 0;
  std::int64_t call_cost_ns = 0;
  std::map<std::int64_t, Timer> timers;
  std::int64_t next_timer_id = shm::kFirstTimerFdId;
  bool alarm_pending = false;
  std::int64_t ended_cpu_ns = 0, children_cpu_ns = 0;
  bool dead = false;
  int threads = 1;         // that ever attached
  bool is_client = false;  // named in the scenario, rather than a child of one
};

struct VirtualCpu {
  std::string robot;
  std::uint32_t core = 0, cores = 1;
  int order = 0;
  double speed = 1.0;
  std::int64_t progress_ns = 0;
  std::vector<Task*> tasks;
};

}  // namespace tcs
