// The coordinator's state and its parts: the choice of the next leaf (engine.cc), the dispatch of a
// thread and its charge (dispatch.cc), what clients say (notifications.cc), and what the kernel
// says (events.cc).
#pragma once

#include <deque>
#include <memory>

#include "coordinator/core/coordinator.h"

namespace tcs {

class Engine {
 public:
  Engine(const Scenario& scenario, const RunOptions& options);
  ~Engine();
  RunReport Run();

 private:
  enum class Tag : std::uint32_t {
    kPipe,
    kTimer,
    kListener,
    kConnection,
    kProcess,
    kAwaited,
    kCommand,
    kSignal,
    kDetector
  };

  // Set-up and end.
  std::string Prepare();
  std::string StartClients();
  void Shutdown();
  void Report(RunReport* report);

  // The choice (engine.cc).
  std::int64_t NextTime(const VirtualCpu& cpu) const;
  std::int64_t OthersNext(const VirtualCpu& cpu) const;
  std::int64_t ReadSafe(const VirtualCpu& cpu) const;
  bool IsRunnable(const Task& task) const;
  bool IsSafe(const Task& task) const;
  Task* Pick(const VirtualCpu& cpu) const;
  VirtualCpu* PickCpu();
  void FireDue(VirtualCpu& cpu);
  void StepCpu(VirtualCpu& cpu);
  void NoteDrift();
  std::int64_t HorizonFor(const Task& task, std::int64_t* idle_until) const;
  void WaitOutside();
  void PollUnseen();

  // The dispatch (dispatch.cc).
  void Dispatch(Task& task, std::int64_t horizon_ns, std::int64_t idle_until_ns);
  void WritePage(Task& task, std::int64_t horizon_ns, std::int64_t idle_until_ns);
  void Resume(Task& task);
  void ArmPreemption(const Task& task);
  bool ReachedHorizon(Task& task);
  void Settle(Task& task);
  void CheckCpuClock(Task& task);
  std::int64_t RunningNow();

  // Notifications (notifications.cc).
  void Handle(Task& task, const shm::Notification& note);
  void WaitForFds(Task& task, const shm::Notification& note);
  void SetTimer(Task& task, const shm::Notification& note);
  void MakeReady(Task& task, shm::WakeReason reason);
  void EndWatches(Task& task);

  // Events (events.cc). Returns true if the running thread has to be stopped.
  bool PollEvents(int timeout_ms);
  void Attach(int connection);
  void ProcessEnded(std::size_t index);
  void DetectorFired();
  void Watch(int fd, std::uint32_t events, Tag tag, std::uint32_t index);
  Task* NewTask(pid_t pid, pid_t parent, VirtualCpu* cpu, const std::string& name, int priority);
  void Warn(const std::string& text);
  shm::ThreadSlot& Slot(const Task& task) {
    return *shm::SlotAt(header_, static_cast<std::uint32_t>(task.slot));
  }

  const Scenario scenario_;
  const RunOptions options_;
  World world_;
  std::deque<VirtualCpu> cpus_;
  std::deque<Process> processes_;
  std::deque<Task> tasks_;
  shm::SegmentHeader* header_ = nullptr;
  int memfd_ = -1, epoll_ = -1, pipe_[2] = {-1, -1}, timer_ = -1, listener_ = -1, signals_ = -1;
  int detector_arm_ = -1, detector_fired_ = -1;
  bool detector_armed_ = false;
  std::string socket_name_;
  std::uint64_t ns_per_tick_q32_ = 0;
  std::int64_t end_ns_ = 0, event_ns_ = 0;
  std::uint64_t ready_counter_ = 0;
  int next_slot_ = 0;
  Task* running_ = nullptr;
  Task* last_ = nullptr;
  bool stop_requested_ = false, notified_ = false, preempted_ = false, external_event_ = false;
  std::int64_t running_horizon_ns_ = 0;
  RunReport report_;
  std::int64_t client_host_ns_ = 0;
};

}  // namespace tcs
