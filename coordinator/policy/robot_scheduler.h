// The decisions of one robot's operating system: which thread has a core next, how far it may run
// (its horizon), whether a thread that wakes preempts one that runs, when a turn is over, and which
// priority a thread has in effect.
//
// Priority. Threads with deadlines precede all others, the earliest deadline first: threads of
// SCHED_DEADLINE, which are throttled where they have used up their budgets (deadline_server.h),
// and the SCHED_OTHER threads of a client that has a relative deadline, which have it from each
// release on. SCHED_FIFO and SCHED_RR follow by their POSIX priorities; SCHED_OTHER and SCHED_BATCH
// have their client's; SCHED_IDLE follows them all. The effective priority is the greatest of a
// thread's own and of the priorities of threads that are blocked on it (priority inheritance).
//
// Quantum. Equals take turns: of 1 ms, of 100 ms under SCHED_RR, without end under SCHED_FIFO and
// where there is a deadline; under set costs of lengths around these (turn_lengths.h). A thread
// that has used its turn up while no equal wanted the core lets the next equal go first that does.
//
// Wake-up preemption. As on Linux, a thread of SCHED_OTHER that time or input wakes goes before its
// equals if it has used less than its fair share of late (share.h). A thread that its own robot's
// threads wake waits for its turn.
//
// Horizon. A core runs on until the first instant at which another thread of the robot could take
// it over: as far as that is known, which is when waits end by themselves and when the rest of the
// scheduler tree could send input.
//
// Cost. Most threads wait for long, and every step looks at all of them. So a thread's wait is
// asked for only when it has changed, and a step reads of most threads nothing but a Glance: the
// glances stand close together in memory.
//
// Pure: knows threads by number, makes no system call, reads no clock. All times are the robot's.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "coordinator/policy/deadline_server.h"
#include "coordinator/policy/run_queue.h"
#include "coordinator/policy/scheduling_parameters.h"
#include "coordinator/policy/share.h"
#include "coordinator/policy/turn_lengths.h"
#include "shm/time_kinds.h"

namespace tcs {

class RobotScheduler {
 public:
  using Thread = RunQueue::Thread;
  using Priority = RunQueue::Priority;
  using Turn = RunQueue::Turn;
  static constexpr Thread kNobody = RunQueue::kNobody;
  static constexpr std::uint64_t kEveryCore = RunQueue::kEveryCore;
  static constexpr VirtualTime kNever = VirtualTime::Never();

  // The state of a thread while it has no core, as the keeper of its waits knows it.
  struct Wait {
    std::uint32_t process = 0;
    bool waits = false;                // else the thread is ready, or its wait is not known
    bool for_input = false;            // the wait may be ended from elsewhere,
    bool for_thread = false;           // or by a thread of its own robot
    bool is_over = false;              // by time, whatever the time on its robot's cores
    VirtualTime until = kNever;        // the wait ends by itself
    VirtualTime own_until = kNever;    // the same, by its process's own clock
    VirtualTime from;                  // the thread runs no earlier once its wait is over
    VirtualTime next_expiry = kNever;  // of its process's timers
  };
  using WaitOf = std::function<Wait(Thread)>;

  // When the rest of the scheduler tree can still wake a core's threads.
  struct Outlook {
    VirtualTime input = kNever;          // another core wakes a thread, at the earliest
    VirtualTime outside_input = kNever;  // a core of another robot does
    VirtualTime output = kNever;         // the dynamics do
    // Under set costs a program acts in the instant in which it is woken.
    bool acts_at_once = false;
    bool has_given_way = false;  // the core, to all leaves that can act at the same instant
  };

  struct Horizon {
    VirtualTime run = kNever;
    VirtualTime idle;  // the thread may sleep that far without asking: nothing else happens
  };

  // `wait_of` is asked for threads that were added and not removed, by Assign, once for each
  // change. Where the world stands still while threads compute, nothing preempts on wake-up; and
  // since a wait's end is told by the process's own clock there, all waits are asked for each time.
  // `turns_seed`: of the lengths of turns (turn_lengths.h); none: each turn is a whole quantum.
  RobotScheduler(std::size_t cores, bool preempts_on_wakeup, WaitOf wait_of,
                 std::optional<std::uint64_t> turns_seed = std::nullopt)
      : preempts_on_wakeup_(preempts_on_wakeup),
        lengths_(turns_seed),
        wait_of_(std::move(wait_of)),
        queue_(cores),
        cores_(cores),
        progress_(cores) {}

  // A new thread of a client with that priority, not ready yet.
  void Add(Thread thread, int client_priority);
  void Remove(Thread thread);
  // The deadline of the thread's client: each release has its deadline so much later.
  void SetClientDeadline(Thread thread, VirtualDuration deadline, VirtualTime now);

  // Requests of threads. A caller that changes parameters, or which thread is blocked on which, has
  // the effective priorities found anew.
  const SchedulingParameters& ParametersOf(Thread thread) const { return At(thread).parameters; }
  void SetParameters(Thread thread, const SchedulingParameters& parameters, VirtualTime now);
  // Admission control: whether the robot's cores can keep the deadlines that it has promised if the
  // thread has these, too. As on Linux a twentieth of the cores is left to others.
  bool Admits(Thread thread, const DeadlineParameters& parameters) const;
  std::uint64_t CoresOf(Thread thread) const { return At(thread).allowed; }  // the robot's only
  bool MayRunAnywhere(Thread thread) const { return CoresOf(thread) == EveryCore(); }
  // False, and nothing has changed, if the robot has none of these cores.
  bool SetCores(Thread thread, std::uint64_t allowed);
  // The child gets the parameters and the cores of its creator, but no deadline.
  void Inherit(Thread child, Thread creator);
  void SetBlockedOn(Thread thread, Thread owner);  // kNobody: it is blocked no longer
  Thread BlockedOn(Thread thread) const { return At(thread).blocked_on; }
  // Finds the effective priority of the thread, and of the threads that it is blocked on, one after
  // the other. True if one of these priorities has changed.
  bool FindEffectivePriority(Thread thread);
  Priority PriorityOf(Thread thread) const { return PriorityAt(At(thread)); }

  // Enqueue: the thread is ready from `from` on, and keeps its place if it was ready. Dequeue: the
  // thread is not ready any more, or has ended. Either way its wait may have changed.
  void Enqueue(Thread thread, VirtualTime from, bool goes_first);
  void Dequeue(Thread thread);
  // The wait of a thread that waits on may have changed, too; or the next expiry of a process's
  // timers has.
  void WaitChanged(Thread thread);
  void ExpiryChanged(std::uint32_t process);
  // The thread's wait is over: the thread has a whole turn before it. If time or another robot has
  // ended the wait, that is a release, and so it is if the thread's deadline is over.
  void WakeUp(Thread thread, VirtualTime now, bool is_release);
  void Yield(Thread thread);
  // The thread has slept after it ran for `ran`, so that the rest of its run begins another turn.
  void SleptSince(Thread thread, VirtualDuration ran);

  void SetProgress(std::size_t core, VirtualTime time) { progress_[core] = time; }
  // Gives each core its next turn, and finds when each acts next; needed after every change.
  // `own_due`: when the robot itself has something to do.
  void Assign(VirtualTime own_due);
  const Turn& Next(std::size_t core) const { return queue_.Next(core); }
  VirtualTime NextActionOf(std::size_t core) const { return cores_[core].next_action; }
  // Whether a wait has ended by itself by then, or a timer has run out. As last assigned.
  bool IsAnythingDue(VirtualTime now) const;

  // Dispatch: a core's thread is about to run. Stop: the thread has stopped after its core has
  // advanced so far, and it has used so much of its turn. Its equals get their turn by EndTurn, so
  // that equals that are due by then have not waited for another turn of the last thread.
  void Dispatch(std::size_t core, Thread thread);
  void Stop(std::size_t core, VirtualDuration advanced, VirtualDuration used);
  void EndTurn(std::size_t core);

  // How far the thread may run on the core, which is no further than `limit`.
  Horizon HorizonOf(std::size_t core, Thread thread, VirtualTime limit,
                    const Outlook& outlook) const;
  // The same where the world stands still while the thread computes, so that only threads that
  // share its process's clock can become due.
  VirtualTime HorizonWhileWorldStands(std::size_t core, Thread thread) const;

  // Whether the thread, woken from elsewhere, goes before its equals after they have run for
  // another `after`.
  bool PreemptsOnWakeup(Thread thread, VirtualDuration after = {}) const;
  // How long after `sent` the thread gets a core if something sent then wakes it, not before
  // `earliest`: the core may have come further. 0 where the thread waits for its turn, too.
  VirtualDuration LatenessOf(Thread woken, VirtualTime sent, VirtualTime earliest,
                             bool goes_first) const;

 private:
  static constexpr Priority kNoPriority = INT64_MIN;

  struct Entity {
    Thread thread = kNobody;
    int client_priority = 0;
    SchedulingParameters parameters;
    std::uint64_t allowed = kEveryCore;
    Priority inherited = kNoPriority;  // from the threads that are blocked on it
    Thread blocked_on = kNobody;
    VirtualDuration client_deadline;  // 0: none
    DeadlineServer server;            // while it has a deadline
    VirtualDuration turn;             // run since its equals last had a turn,
    VirtualDuration turn_length;      // of this length
    Wait wait;                        // as last asked for
  };
  // Of the entity at the same place in entities_.
  struct Glance {
    Priority priority = 0;     // effective
    Share share;               // of the time that the thread and its equals have had
    VirtualTime due = kNever;  // the wait and the timers of the process do not end before
    std::uint32_t process = 0;
    bool waits = false;
    bool for_others = false;  // for input or another thread, and not for time alone
    bool is_stale = true;     // the wait has to be asked for
  };
  struct Core {
    Thread running = kNobody;
    Priority priority = 0;       // of the running thread when it began,
    std::size_t sharing = 0;     // and how many threads were ready at that
    VirtualTime charged_to;      // so far the thread's budget is charged
    Thread turn_over = kNobody;  // goes behind its equals, once one of them wants the core
    VirtualTime next_action = kNever;
  };

  const Entity* Find(Thread thread) const;
  Entity* Find(Thread thread) { return const_cast<Entity*>(std::as_const(*this).Find(thread)); }
  const Entity& At(Thread thread) const;
  Entity& At(Thread thread) { return const_cast<Entity&>(std::as_const(*this).At(thread)); }
  std::size_t PlaceOf(const Entity& entity) const {
    return static_cast<std::size_t>(&entity - entities_.data());
  }
  const Glance& GlanceAt(const Entity& entity) const { return glances_[PlaceOf(entity)]; }
  Glance& GlanceAt(const Entity& entity) { return glances_[PlaceOf(entity)]; }
  Priority PriorityAt(const Entity& entity) const { return GlanceAt(entity).priority; }
  std::uint64_t EveryCore() const;

  static bool HasDeadline(const Entity& entity);
  static Priority OwnPriority(const Entity& entity);
  Priority PriorityIfWoken(const Entity& entity, VirtualTime now) const;
  static std::optional<VirtualDuration> QuantumOf(const Entity& entity);
  void BeginTurn(Entity& entity, VirtualTime now);
  void DrawTurnLength(Entity& entity, VirtualTime now) const;
  static bool HasUsedTurnUp(const Entity& entity);
  void StartServer(Entity& entity, VirtualTime now);
  void ChargeBudget(Core& core, VirtualTime now);
  void ChargeBudgetOf(Thread thread);

  void MarkStale(std::size_t place);
  void Ask(std::size_t place);
  void AskForStaleWaits();
  VirtualTime FirstDue() const;
  VirtualTime DueAt(VirtualTime progress) const;
  VirtualTime TurnEnd(std::size_t core, const Entity& running) const;
  VirtualTime PastInput(std::size_t core, VirtualTime input, const Outlook& outlook) const;
  VirtualTime HorizonForInput(std::size_t core, const Entity& running, const Entity& other,
                              const Wait& wait, const Outlook& outlook) const;
  bool CanPreemptOnWakeup(const Entity& entity) const;
  bool PreemptsOnWakeup(const Entity& entity, VirtualDuration after) const;
  bool MakesRoom(std::size_t core, const Entity& woken, VirtualTime due) const;
  void ShareOut(const Core& core, VirtualDuration ran);

  bool preempts_on_wakeup_;
  TurnLengths lengths_;
  WaitOf wait_of_;
  RunQueue queue_;
  std::vector<Core> cores_;
  std::vector<VirtualTime> progress_;  // of the cores
  std::vector<Entity> entities_;
  std::vector<Glance> glances_;
  std::vector<int> places_;                 // in entities_, by thread; -1: not here
  std::vector<Thread> stale_;               // whose waits are to be asked for; may have ended since
  mutable VirtualTime first_due_ = kNever;  // the least of the glances', if that is known
  mutable bool knows_first_due_ = false;
};

}  // namespace tcs
