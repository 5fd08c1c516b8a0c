// A machine with one processor that exists in numbers only: its time, who of a run's threads has
// the processor, what they wait for in the kernel, and what they have computed. The coordinator is
// the code that runs outside of all threads; while it computes, sleeps or asks for something, time
// passes here and nowhere else.
//
// What a kernel may do at any time, this one does by its seed: be late with timers, give the
// processor to somebody of another's for a while, wake a thread for nothing, and, where priorities
// do not forbid it, let threads run while the coordinator computes.
//
// There is one at a time, which the port's functions (port.cc) and the shim's door (door.cc) find
// by Kernel::This().
#pragma once

#include <sys/types.h>
#include <ucontext.h>

#include <array>
#include <atomic>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <vector>

#include "coordinator/port/traps.h"
#include "tests/simulate/descriptors.h"
#include "tests/simulate/luck.h"
#include "tests/simulate/threads.h"

namespace tcs::simulate {

class Kernel {
 public:
  Kernel(std::uint64_t seed, bool has_levels);
  ~Kernel();
  Kernel(const Kernel&) = delete;
  Kernel& operator=(const Kernel&) = delete;
  static Kernel& This();

  std::int64_t now_ns() const { return now_ns_; }
  // Two ticks a nanosecond: a unit taken for another one shows.
  std::uint64_t tsc() const { return static_cast<std::uint64_t>(now_ns_) * 2; }
  bool has_levels() const { return has_levels_; }

  SimThread& AddThread(SimProcess& process, pid_t tid, std::function<void()> body);
  SimThread* Find(pid_t tid);
  std::deque<SimThread>& threads() { return threads_; }
  const std::deque<SimThread>& threads() const { return threads_; }
  std::vector<pid_t> ThreadsOf(pid_t pid) const;
  // A descriptor that is readable once the process has ended.
  void Watch(int fd, pid_t pid) { watched_[fd] = pid; }
  void Kill(pid_t pid);
  void KillWatched(int fd) { Kill(watched_[fd]); }
  bool HasEnded(pid_t pid) const;
  // The CPU clock of a thread is read by a descriptor.
  void OpensClock(int fd, pid_t tid) { clocks_[fd] = tid; }
  SimThread* OfClock(int fd) { return Find(clocks_[fd]); }
  void SetLevel(SimThread& thread, int level);
  Descriptors& descriptors() { return descriptors_; }
  // Null: the coordinator runs.
  SimThread* running() { return running_; }

  // Has each thing that happens written to stderr.
  void Trace() { traces_ = true; }
  bool traces() const { return traces_; }
  void Note(const SimThread& thread, const char* what, std::int64_t value = 0) const {
    if (traces_) WriteNote(thread, what, value);
  }

  // The coordinator computes, or has the kernel do something for it. Where there are no levels
  // others may come between.
  void Spend(std::int64_t ns);
  // It sleeps until `has_events`, at most so long (negative: without limit).
  void Sleep(const std::function<bool()>& has_events, std::int64_t timeout_ns);
  void ArmDetector(int fired_fd);
  // Called with each thread that goes on with its program.
  void OnProgram(std::function<void(const SimThread&)> watch) { watch_ = std::move(watch); }

  // The running thread computes; `of_program`: what it is to be charged for.
  void Compute(std::int64_t ns, bool of_program);
  // The same for the shim: what it does again and again takes what is left of its time at once.
  void ComputeInShim(std::int64_t ns);
  // It waits at the word while that has the value, and by the clock at most so long. Returns as the
  // kernel does.
  long WaitAt(const std::atomic<std::uint32_t>& word, std::uint32_t value, std::int64_t timeout_ns);
  // It makes a call that the coordinator answers.
  long Trap(long number, const long (&args)[6]);
  // It is held by the kernel in a call that nobody is told of.
  void BlockFor(std::int64_t ns);
  // It has made something ready that the coordinator waits for.
  void Notified();
  // The handler that all threads have for the signal, and what the running one blocks.
  void SetHandler(int signal, unsigned long handler);
  unsigned long HandlerOf(int signal) const { return handlers_[static_cast<std::size_t>(signal)]; }
  void SetBlocked(std::uint64_t signals);

  void WakeAt(const std::atomic<std::uint32_t>& word);
  void SendToGate(pid_t tid, std::uint64_t dispatch);
  void Send(SimThread& thread, int signal);
  void SendTimer(const TimerSignalRequest& request);
  // The running thread comes back from a call.
  void Returns() { Deliver(*running_); }
  void SendToProcess(SimProcess& process, int signal);
  // For those of them that have a handler.
  std::uint64_t Caught() const;
  std::optional<TrappedCall> ReceiveTrapped(int listener);
  bool Answer(std::uint64_t id, long result);
  bool HasAnswerToTake(std::uint64_t id);

 private:
  void WriteNote(const SimThread& thread, const char* what, std::int64_t value) const;
  SimThread* Next();
  void Run(SimThread& thread, std::int64_t until_ns);
  void Die(SimThread& thread);
  // The running thread stops here, until it has the processor again.
  void Stop();
  std::uint64_t Deliverable(const SimThread& thread) const;
  // It goes back to its program, which it has left in a system call (`call`) or elsewhere (null).
  void Deliver(SimThread& thread, ucontext_t* call = nullptr);
  void Interrupt(SimThread& thread);
  void InterruptWait(SimThread& thread);
  void Wake(SimThread& thread, long result);
  void WakeDue();
  void WaitUntil(SimThread& thread, SimThread::State state, std::int64_t until_ns);
  std::int64_t NextDue() const;
  std::int64_t Lateness();

  static Kernel* this_;

  const bool has_levels_;
  Luck luck_;
  Descriptors descriptors_;
  std::int64_t now_ns_;
  std::deque<SimThread> threads_;
  SimThread* running_ = nullptr;
  std::int64_t until_ns_ = 0;
  std::int64_t none_due_before_ns_ = INT64_MAX;
  bool has_said_ = false;
  int detector_fd_ = -1;  // armed
  std::array<unsigned long, 65> handlers_{};
  std::uint64_t last_call_ = 0;
  std::int64_t queued_ = 0;
  bool traces_ = false;
  std::map<int, pid_t> clocks_, watched_;
  std::function<void(const SimThread&)> watch_;
};

}  // namespace tcs::simulate
