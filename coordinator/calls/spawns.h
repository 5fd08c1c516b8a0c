// New threads and processes, which are known from their creation on, and held until their first
// dispatch.
//
// A program makes a thread or a process by a trapped call. The shim tells next of those that it has
// made itself (kMadeThread, kSpawned), and they attach at their first turn. All other threads and
// processes (of the C library's own, of other libraries, of bare clones, and those whose maker says
// something else before) have their places at once, as if they had attached, and may attach when
// they first make a call that the shim sees. Two kinds have no place: a child by vfork that has its
// parent's memory acts in its parent's place until it executes another program; and a child that
// has this memory without being a thread is not managed (processes/unregistered_children.h).
//
// For the coordinator's thread only.
#pragma once

#include <sys/types.h>

#include "coordinator/calls/scheduling_calls.h"
#include "coordinator/host/executor.h"
#include "coordinator/processes/bare_programs.h"
#include "coordinator/processes/registration.h"
#include "coordinator/processes/thread_creation.h"
#include "coordinator/processes/unregistered_children.h"
#include "coordinator/processes/unregistered_threads.h"
#include "coordinator/tasks/event_time.h"
#include "coordinator/tasks/run_state.h"
#include "shm/layout.h"

namespace tcs {

class Spawns {
 public:
  // The parts that Spawns needs, and that outlive it.
  struct Parts {
    Executor& executor;
    ThreadCreation& thread_creation;
    Registration& registration;
    SchedulingCalls& scheduling;
    BarePrograms& bare_programs;
    UnregisteredChildren& unregistered_children;
    const UnregisteredThreads& unregistered;
  };

  Spawns(RunState& run, Parts parts) : run_(run), parts_(parts) {}

  // The shim makes what the thread makes now, and will tell of it.
  static bool IsAnnounced(const Task& maker);
  // The thread makes a thread or a process by that call, which the kernel carries out next.
  static void Begin(Task& maker, const TrappedCall& call);
  // The kernel may have made the thread or the process by now. The shim may still tell of those
  // that it makes itself.
  void LookForCreations(Task& maker, EventTime when) { TakeIn(maker, when, false, false); }
  // Of a thread that waits in the kernel, by vfork, for its child: the child is there. Before, the
  // thread waits for something else, as for the lock of a file that it maps.
  bool HasMadeChild(Task& maker, EventTime when);
  // The thread's turn is over; or it says something else than what it was to tell, and the kernel
  // is through with its call.
  void TurnEnds(Task& maker, EventTime when) { TakeIn(maker, when, true, false); }
  void MakerSpeaks(Task& maker, EventTime when) { TakeIn(maker, when, true, true); }
  // A thread that nobody knows has made a call: it may be one that another thread makes. True: the
  // thread is not known yet, but will be once its maker has gone on.
  bool IsUnborn(pid_t tid, EventTime when);
  // The thread in whose place the thread `tid`, which is no other's, acts; null: the thread `tid`
  // acts for itself.
  Task* ActsFor(pid_t tid);
  // kSpawned, kMadeThread.
  void Announced(Task& maker, const shm::Notification& note);

 private:
  void AnnouncedThread(Task& maker, const shm::Notification& note);
  void AnnouncedProcess(Task& maker, pid_t pid);
  void TakeIn(Task& maker, EventTime when, bool announced_too, bool is_done);
  bool TakeInThread(Task& maker, const CloneCall& call, EventTime when);
  bool TakeInChild(Task& maker, const CloneCall& call, EventTime when);
  Task& AddThread(Task& maker, pid_t tid, VirtualTime at);
  Task& AddChild(Task& maker, pid_t pid, VirtualTime at);
  pid_t ThreadOf(const Task& maker, const CloneCall& call) const;
  bool IsNew(const Task& maker, pid_t tid) const;

  RunState& run_;
  const Parts parts_;
};

}  // namespace tcs
