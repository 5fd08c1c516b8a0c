// The coordinator's own idea of threads, processes and virtual CPUs. Nothing here is shared with
// clients.
#pragma once

#include <sys/types.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "coordinator/host/host_thread.h"
#include "coordinator/os/clone_call.h"
#include "coordinator/os/descriptor_broker.h"
#include "coordinator/policy/robot_scheduler.h"
#include "coordinator/policy/temporal_consistency.h"
#include "coordinator/policy/wakeup_latency.h"
#include "coordinator/port/proc_files.h"
#include "coordinator/port/traps.h"
#include "coordinator/port/unique_fd.h"
#include "coordinator/prices/price_list.h"
#include "coordinator/queues/process_timers.h"
#include "coordinator/tasks/ended_children.h"
#include "coordinator/tasks/kept_files.h"
#include "coordinator/tasks/process_link.h"
#include "coordinator/tasks/program_clock.h"
#include "coordinator/tasks/task_state.h"
#include "coordinator/tasks/usage.h"
#include "coordinator/tasks/wait.h"
#include "coordinator/trace/activation_log.h"
#include "shm/check.h"
#include "shm/draws.h"
#include "shm/layout.h"
#include "shm/time_kinds.h"

namespace tcs {

// The effects on others of a trapped call that the kernel carries out (after_calls.cc).
enum class AfterCall {
  kNone,
  kBacklogs,
  kTaken,
  kSignals,
  kKernelWaits,
  kObjects,
  kContinued,
  kTerminals,
  kCreations
};

// A thread or a process that a thread is making, or has made: the coordinator looks for it until it
// is known (calls/spawns.h).
struct Creation {
  CloneCall call;
  bool is_announced = false;  // the shim has made it, and tells of it next
};

// A thread's wait for others that it computes through.
struct SpinWait {
  VirtualTime since;
  bool only_yields = false;    // the thread has yielded, and may look at memory
  bool is_first = false;       // of the thread's looks in a row
  bool was_stopped = false;    // the thread span a moment before it was stopped
  bool reads_clock = false;    // the thread looks at its clock, too
  bool has_waited = false;     // for its next look, as others have acted
  std::uint64_t has_seen = 0;  // of what threads of its robot have done, by Robot::acts
};

struct ClientSpec;
struct Process;
struct Robot;
struct VirtualCpu;

struct Task : HostThread {
  Process* process = nullptr;
  VirtualCpu* cpu = nullptr;  // dispatched on last; null before the first time
  pid_t own_tid = 0;          // by which its process knows it (os/own_number.h)
  int slot = -1;              // -1: not registered yet
  int order = 0;              // of registration; the thread's number in the scheduling policies
  TaskState state = TaskState::kStarting;
  // The time that the thread has come to: that of its last stop, or of the event that has made it
  // ready since. Changed by ComeTo only.
  VirtualTime reached;
  VirtualTime started_at;
  shm::NotificationKind hold = shm::NotificationKind::kNone;  // kRead or kWrite while kHolding
  std::optional<Wait> wait;                                   // while kWaiting
  VirtualDuration lead;              // of its process's clock when it last stopped
  std::int64_t children_looked = 0;  // of its process's children_changed when it last came to wait
  std::uint64_t fds_order = 0;       // of waiting for descriptors, over several attempts
  std::optional<KeptFiles> kept;     // of its call, from a wait on that is over
  bool passes_on = false;            // other threads were passed over for it (one_waiter.cc)
  bool is_deliverer = false;         // of DDS messages, to its process
  std::optional<VirtualTime> messages_until;  // messages due by then are for its next dispatch,
  std::optional<std::size_t>
      messages_charged;  // so many of them: it is charged for receiving these
  int trap_listener = -1;
  std::uint64_t trap_id = 0;       // the thread stopped in a trapped call instead of at its gate
  std::int64_t trap_result = 0;    // the call is to return this,
  UniqueFd trap_file;              // or a descriptor of this, which lives on when the thread
  bool trap_file_on_exec = false;  // executes another program
  // The thread had left the call, and may make it again: for the result that it has missed.
  bool answer_lost = false;
  std::optional<TrappedCall> early_trap;    // made without being dispatched: for its next dispatch
  bool trap_continues = false;              // or the kernel carries it out
  AfterCall after_call = AfterCall::kNone;  // of the call that the kernel carries out
  bool is_brief = false;                    // the thread runs for that call only,
  bool brief_done = false;                  // as has been seen,
  std::uint64_t brief_id = 0;               // by which it was trapped; 0: it is being made,
  HostDuration brief_until;                 // until its CPU clock shows that
  bool expects_kernel = false;              // in its next call the kernel may hold it
  TrappedCall unanswered_call;              // the last call that the thread stopped in,
  TrappedCall trapped_call;                 // and the last one but futex calls
  TrappedCall sending;         // by which the C library sends a signal for the thread, until its
                               // shim says that it is sent; number 0: none
  std::uint64_t end_word = 0;  // the kernel clears it at the thread's end; 0: unknown
  // The priority-inheriting lock that has been handed to the thread, which does not know it yet; 0:
  // none.
  std::uint64_t handed_lock = 0;
  shm::WakeReason reason = shm::WakeReason::kGo;
  std::int64_t reply[2] = {0, 0};
  VirtualDuration debt;  // executed beyond a horizon, or a price: passes first at the next dispatch
  int used_up = 0;       // dispatches in a row that ended at their horizon: the thread is computing
  VirtualDuration charged;
  VirtualDuration priced;              // of that: not computed (RunState::ChargePrice)
  std::int64_t settled_adjust_ns = 0;  // of its clock page, as the last turn ended
  bool is_cut_off = false;             // the thread has been told that its connection is gone
  UniqueFd cpu_clock_fd;               // where its CPU clock is read, if it is not its process's
  int yields = 0;           // since the last look whether unregistered children wait for theirs
  bool owes_ahead = false;  // has computed ahead what it has not paid yet (computing_ahead.h),
  static constexpr int kComputes = 3;  // `used_up` of a thread that is expected to go on
  int ahead_after = kComputes;         // the thread computes ahead once that is so much
  VirtualDuration ahead_from;          // from that charge on
  // How many of the thread's turns in a row were short, and how many have to be for a turn beside
  // the coordinator (beside_cpu.h); and how far that turn goes.
  int short_turns = 0, beside_after = 3;
  VirtualTime beside_horizon;
  bool died_beside = false;  // with its process, in the turn that it has there
  HostDuration ran;          // in its last turn
  bool spins = false;        // computes on and on on an ideal robot
  // The thread waits for another core by looking at memory (tasks/spin_waits.h); `asked_at`: when
  // the thread was last asked whether it does so without pausing.
  std::optional<SpinWait> spin;
  VirtualTime asked_at;
  bool notified_early = false;  // has notified without being dispatched: answered at its dispatch
  std::vector<Creation> creations;  // begun by the thread, the earliest first
  bool in_vfork = false;            // the thread is in the kernel until its child executes or ends
  // The thread has its place, but does not know of it: it has made no call yet that the shim sees.
  bool is_adopted = false;
  std::uint64_t tls = 0;       // of a thread that was adopted at its creation; 0: unknown
  bool can_be_stopped = true;  // the thread has the handler that brings it to its gate
  bool executes = false;       // another program, perhaps: the thread has no handlers there
  // The thread's gate has been opened, and nothing that the thread has said since has been heard.
  bool is_let_go = false;
  bool has_signal = false;          // ours, to go to its gate, unless it has handled it by now
  bool is_put_off = false;          // has notified, and is heard later (gate_keeper.h),
  bool is_call_put_off = false;     // or its trapped call has been received, and is taken later
  shm::WorkCounts work{};           // so far,
  std::uint64_t trapped_calls = 0;  // with those of its calls that the shim has not seen
  std::int64_t activations = 0;
  Activation activation;           // the present one, while the thread does not wait
  bool is_further = false;         // not the first thread of a client
  std::uint64_t posts_taken = 0;   // of its command ring (shm/command_ring.h): the next one's place
  std::uint32_t changes_seen = 0;  // of its slot's descriptors_changed
  int row = 0;                     // in the schedule trace and the log of dispatches

  void ComeTo(VirtualTime time) {
    TCS_CHECK(time >= reached);
    reached = time;
  }

  // The trapped call has been answered, or was left to the kernel; or the thread had left the call.
  void WasAnswered(bool was_there) {
    if (was_there && !trap_continues) handed_lock = 0;
    answer_lost = !was_there && !EndsBySignal(trap_result);
    trap_id = 0;
  }

  // The object of the thread's wait, if that is of this kind.
  template <class Kind>
  const Kind* Awaits() const {
    return wait.has_value() ? wait->As<Kind>() : nullptr;
  }
  template <class Kind>
  Kind* Awaits() {
    return wait.has_value() ? wait->As<Kind>() : nullptr;
  }
};

// The signals that do not reach the thread: the signals that it blocks, or its wait does.
inline std::uint64_t BlockedOf(const Task& task, const SignalSets& sets) {
  const auto mask = task.wait.has_value() ? MaskOf(*task.wait) : std::nullopt;
  return mask.value_or(sets.blocked);
}

struct Process {
  std::unique_ptr<ProcessLink> link;  // null before its first attach, and once it has ended
  std::uint32_t index = 0;            // the process's place in TaskTable::processes
  Process* client = nullptr;          // the client that the process is or descends from
  const ClientSpec* spec = nullptr;   // of a client
  pid_t pid = 0, parent = 0;
  pid_t own_pid = 0;                // by which the process knows itself (os/own_number.h),
  std::uint64_t pid_namespace = 0;  // and where; 0: in tcsim's
  UniqueFd pidfd;
  std::unique_ptr<DescriptorBroker>
      broker;  // null where there are none, and before its first attach
  Robot* robot = nullptr;
  std::string name;
  int priority = 0;
  VirtualDuration deadline;  // the client's, under scheduler: edf; 0: none
  VirtualDuration call_cost;
  std::optional<VirtualDuration> allocation_cost;
  bool is_bare = false;  // the program runs without the shim (bare_programs.h)
  bool patch_vdso = false, leads_counter = false, dds_endpoints = false;
  shm::Draws draws;  // by trapped calls, where they repeat
  ProgramClock clock;
  ProcessTimers timers;
  std::map<std::int64_t, UniqueFd> timer_fds;  // of timers that have one, by the timer's id
  // Timers of which the program has no descriptor left, though calls on them were waiting then.
  std::vector<std::int64_t> closed_timers;
  // When a timer last ran out, as the virtual CPU's time, while no thread has come to wait since.
  VirtualTime expired = VirtualTime::Never();
  EndedThreads ended;  // and how many periodic expiries found no thread waiting
  Usage descendants;   // of processes that have ended and descended from this client
  VirtualDuration children_cpu;
  EndedChildren ended_children;
  std::int64_t children_changed = 0;  // how often a child ended, stopped or went on
  bool stopped = false;               // by a signal, when last looked at
  // As long as the process's parent may not have been told.
  bool stop_is_news = false, continue_is_news = false;
  std::uint32_t dds_number = 0;   // in dds::Hub; 0: not joined
  bool pays_for_silence = false;  // a client: the threads compute for long without calls
  VirtualTime acted_until;        // when its threads last did more than spin, as far as it is known
  VirtualTime stays_close_until;  // the threads' cores do to each other (tasks/spin_waits.h)
  bool stays_home = false;        // the threads do not compute ahead (computing_ahead.h)
  bool counter_warned = false;    // a client: of what it, or a descendant, reads by rdtsc
  bool dds_warned = false;        // a client: of what it, or a descendant, sends
  bool has_erred = false;         // the client, or a descendant, has violated the protocol
  Task* deliverer = nullptr;      // the thread that takes the process's DDS messages
  bool dead = false;
  bool killed = false;                      // at the end of its grace
  bool violates_protocol = false;           // killed, for what it has written into shared memory
  int threads = 1;                          // that ever attached
  DescriptorChanges changes;                // of its descriptors
  bool has_unregistered_threads = false;    // threads that will never attach
  bool is_client = false;                   // named in the scenario, rather than a child of one
  int wait_status = 0;                      // once dead, of the coordinator's own children
  std::optional<std::uint64_t> most_cpu_s;  // the most that the process may compute (cpu_limit.h)
  bool asked_for_io_uring = false;          // which it was refused
  VirtualTime started_at;
  std::optional<VirtualTime> ended_at;
  OutsideUsage outside;  // a client's, with its descendants'
};

struct VirtualCpu {
  Robot* robot = nullptr;
  std::uint32_t core = 0;
  VirtualTime progress;  // changed by ComeTo only
  VirtualDuration busy;  // how much was computed on it
  TemporalConsistency::Leaf leaf = -1;
  // Of an ideal robot's virtual CPU: where the CPU has been standing, and since when.
  std::optional<VirtualTime> stands_at;
  HostTime stands_since;

  void ComeTo(VirtualTime time);
};

struct Robot {
  Robot(std::string its_name, double its_speed, RobotScheduler its_scheduler)
      : name(std::move(its_name)), speed(its_speed), scheduler(std::move(its_scheduler)) {}

  std::string name;
  double speed;
  double outside_speed = 1.0;  // virtual seconds for each real one that is waited outside
  WakeupLatency wakeup;
  PriceList prices;
  std::uint32_t number = 0;  // in the scenario's order, from 1 on
  bool is_ideal = false;     // the robot's threads are charged nothing
  bool is_ours = false;      // tcsim's own: no run goes on for its programs
  bool is_reached = false;   // nothing is local to it any more (calls/local_sockets.h)
  std::uint64_t acts = 0;    // turns of its threads that did more than spin
  // Others than the robot's own programs send it signals (engine/turns_beside.h).
  bool is_disturbed = false;
  RobotScheduler scheduler;
  VirtualTime next_launch = VirtualTime::Never();  // when its next client starts
  std::vector<VirtualCpu*> cpus;                   // by core
  std::vector<Task*> tasks;                        // the living
  bool keeps_timer_signals =
      false;  // some of its processes' timers' wait to be sent (TimerSignals)

  // How far the robot may have come: its cores, and turns that have begun before their order.
  VirtualTime Furthest() const;
};

// The time on the process's clock where the thread is.
inline ProgramTime OwnNow(const Task& task) { return task.process->clock.At(task.reached); }

inline VirtualTime Robot::Furthest() const {
  VirtualTime furthest;
  for (const VirtualCpu* cpu : cpus) furthest = std::max(furthest, cpu->progress);
  for (const Task* task : tasks) {
    if (task->turns_beside) furthest = std::max(furthest, task->beside_horizon);
  }
  return furthest;
}

inline void VirtualCpu::ComeTo(VirtualTime time) {
  TCS_CHECK(time >= progress);
  progress = time;
  robot->scheduler.SetProgress(core, time);
}

}  // namespace tcs
