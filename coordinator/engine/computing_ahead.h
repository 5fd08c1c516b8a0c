// Threads that compute on further processors of the host, ahead of their turns
// (host/further_cpu.h).
//
// The order of turns stays what it is: one after the other, the least advanced virtual CPU first.
// But a turn in which a thread would compute what it has computed already is over at once, and
// where the thread has not come so far it is waited for. The time computed ahead is a debt, like
// time that other threads compute beyond their horizons, and no more than leaves may be apart.
// Until the debt is paid the thread does nothing to others, because it has computed that time
// without a call. So the others may go on until then.
//
// Only programs of ordinary priority are sent, under measured accounting, where the world goes on
// meanwhile: a real-time program may rely on no other thread running beside it on its only core.
// For the coordinator's thread only.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <vector>

#include "coordinator/host/beside_cpu.h"
#include "coordinator/host/executor.h"
#include "coordinator/host/further_cpu.h"
#include "coordinator/host/host_cpu.h"
#include "coordinator/processes/run_records.h"
#include "coordinator/tasks/reactor.h"
#include "coordinator/tasks/run_clock.h"
#include "coordinator/tasks/run_state.h"
#include "coordinator/tasks/waker.h"

namespace tcs {

class ComputingAhead {
 public:
  struct Parts {
    RunState& run;
    Waker& waker;
    HostCpu& cpu;
    Executor& executor;
    const RunClock& clock;
    RunRecords& records;
  };
  // `poll` handles what has happened by now, as something of that moment.
  ComputingAhead(const Parts& parts, std::function<PollOutcome(EventTime)> poll)
      : parts_(parts), poll_(std::move(poll)) {}

  // The processors that a run with its turns on `home` may use besides. To be asked before this
  // process is bound to one.
  static std::vector<int> CpusBeside(int home, const RunState& run);
  // Where short turns keep the first of them busy, no thread is sent there.
  void Open(int home, const std::vector<int>& further, const BesideCpu* beside);

  // The thread's turn has just ended. If the thread computes on, it may do so on another processor.
  void SendIfItComputes(Task& task);
  // The thread has made a call, or looked at its clock; nothing happens if the thread does not
  // compute ahead.
  void HasSpoken(Task& task);
  // Anything that becomes of the process takes effect once the process's thread has paid: at that
  // time, or now if the thread owes nothing.
  VirtualTime EndOfDebt(const Process& process) const;
  // The process's threads take turns only, from now on, because the memory that they share is
  // changed here, too. Null: the threads of all processes.
  void StayHome(Process* process);
  // Another thread of the process waits in the kernel, perhaps for the map of the process's memory,
  // which a thread that computes ahead has there. A thread that has come to its limit was stopped
  // with the map, and is at home from now on, where it can be let finish
  // (kernel_blocked_threads.h). `long_held`: so are the threads that compute, for others may keep
  // them from their processors.
  void BringHomeHolders(const Process& process, bool long_held);
  // Helpers of the physics need the further processors, too: no thread keeps them from there.
  void MakeRoomForHelpers();
  // The thread has ended.
  void Forget(const Task& task);
  // Whether a thread computes ahead on the processor of that number.
  bool IsOn(int cpu) const;
  // The further processors, whichever threads are there.
  const std::deque<FurtherCpu>& cpus() const { return cpus_; }

  // The virtual CPU's next turn is of a thread that has computed ahead, or does so.
  bool IsNextOn(const VirtualCpu& cpu) const;
  // The time up to which the virtual CPU does nothing to others: until the thread has paid, or
  // others of its robot act.
  VirtualTime EndOfDebt(const VirtualCpu& cpu) const;
  // Looks how far the threads have come that compute ahead, so that others may go on as far.
  void Look();
  // The thread's turn, up to that horizon. False if the thread has paid all, and is to be
  // dispatched.
  bool TakeTurn(Task& task, VirtualTime horizon);

 private:
  bool MaySend(const Task& task) const;
  VirtualDuration MostAhead() const;
  void BringHome(Task& task);
  void Charge(Task& task, VirtualDuration charged);
  void ChargeAhead(Task& task);
  VirtualDuration Uncertain(const Task& task);
  void AskHowFar(Task& task);
  void Await(Task& task, VirtualTime horizon);
  void Pay(Task& task, VirtualTime horizon);
  FurtherCpu& CpuOf(const Task& task);

  const Parts parts_;
  const std::function<PollOutcome(EventTime)> poll_;
  std::deque<FurtherCpu> cpus_;
  const BesideCpu* beside_ = nullptr;
  bool stays_home_ = false;
  std::vector<Task*> owing_;  // threads that have computed ahead and not paid yet
};

}  // namespace tcs
