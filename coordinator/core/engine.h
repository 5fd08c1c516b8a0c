// The coordinator's state and its parts: the loop and the choice of who acts (engine.cc), set-up
// (setup.cc) and end (finish.cc), the dispatch of a thread and its charge (dispatch.cc), what
// clients say (notifications.cc), their timers (timers.cc) and signals (signals.cc), and what the
// kernel says (events.cc).
#pragma once

#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "coordinator/core/activations.h"
#include "coordinator/core/child_stops.h"
#include "coordinator/core/coordinator.h"
#include "coordinator/core/dds_gateway.h"
#include "coordinator/core/descriptor_waits.h"
#include "coordinator/core/expulsion.h"
#include "coordinator/core/futex_calls.h"
#include "coordinator/core/futex_words.h"
#include "coordinator/core/kernel_object_waits.h"
#include "coordinator/core/lock_futexes.h"
#include "coordinator/core/moment.h"
#include "coordinator/core/priority_inheritance.h"
#include "coordinator/core/raw_scheduling.h"
#include "coordinator/core/raw_timers.h"
#include "coordinator/core/reactor.h"
#include "coordinator/core/run_clock.h"
#include "coordinator/core/run_records.h"
#include "coordinator/core/run_state.h"
#include "coordinator/core/scheduling_calls.h"
#include "coordinator/core/shared_events.h"
#include "coordinator/core/signal_calls.h"
#include "coordinator/core/signal_wakes.h"
#include "coordinator/core/slot_check.h"
#include "coordinator/core/standstill_watch.h"
#include "coordinator/core/timer_calls.h"
#include "coordinator/core/timer_signals.h"
#include "coordinator/core/unknown_children.h"
#include "coordinator/core/unmanaged_threads.h"
#include "coordinator/core/usage_book.h"
#include "coordinator/core/waker.h"
#include "coordinator/core/world.h"
#include "coordinator/host/executor.h"
#include "coordinator/host/host_cpu.h"
#include "coordinator/host/meter.h"
#include "coordinator/os/cpu_claim.h"
#include "coordinator/os/stop_request.h"
#include "coordinator/policy/temporal_consistency.h"
#include "shm/clock_page.h"

namespace tcs {

class Engine {
 public:
  Engine(const Scenario& scenario, const RunOptions& options);
  ~Engine();
  RunReport Run();

 private:
  // Set-up (setup.cc). Empty on success, else one sentence.
  std::string Prepare();
  std::string PrepareMemory();
  std::string PrepareListener();
  // Where a client and its descendants register.
  struct Listener {
    UniqueFd fd;
    Process* client;
  };
  // Somebody who has not said yet what it wants.
  struct Connection {
    UniqueFd fd;
    Process* client;  // that its listener is for
  };
  std::string OpenListener();
  std::string PrepareHostCpu();

  // When the clients start (launches.cc).
  struct Launch {
    const ClientSpec* spec;
    Robot* robot;
    std::int64_t start_ns;  // never: it waits for another one to end
    Process* process;       // once started
  };
  std::string PrepareFolders();
  std::string StartClients();
  std::string Start(Launch& launch, std::int64_t at_ns);
  void StartDue(Robot& robot, std::int64_t now_ns);
  void FindNextLaunch(Robot& robot);
  bool HasLaunchAhead() const;
  void StartThoseAfter(const Process& ended);
  void WarnOfNeverStarted();

  // The loop (engine.cc).
  bool Step();
  bool AwaitDeaths();
  std::int64_t MostHeldNs() const;
  std::int64_t LeftToHoldNs(const Task& task) const;
  void LetWorldGoOnWithout(Task& task);
  void PayDebt(Task& task, std::int64_t ns);
  void StepCpu(VirtualCpu& cpu);
  bool StepWorld();
  std::int64_t KeepWorldNear(const Task& task, std::int64_t horizon_ns);
  bool HasJumpedOver();
  std::int64_t HorizonFor(const Task& task, std::int64_t* idle_until);
  void PollUnseen();
  bool UnmanagedRun() const;
  void WaitOutside();
  bool AwaitOutside();
  std::int64_t FurthestNs() const;
  void LookAround();
  void ShowProgress();

  // The door (waker.h).
  void SetState(Task& task, TaskState state) { waker_.SetState(task, state); }
  void Refresh(Robot& robot) { waker_.Refresh(robot); }
  void MakeReady(Task& task, shm::WakeReason reason, Moment moment) {
    waker_.Wake(task, reason, moment);
  }
  void EnterWait(Task& task, Wait wait) { waker_.Wait(task, std::move(wait)); }
  void TellOfWaits();

  // The dispatch (dispatch.cc).
  void Dispatch(Task& task, std::int64_t horizon_ns, std::int64_t idle_until_ns);
  bool AnswerEarly(Task& task);
  void BeginTurn(Task& task, std::int64_t horizon_ns, std::int64_t idle_until_ns);
  void EndTurn(Task& task);
  void TellOthersOf(Task& task, Moment call, bool looks_again);
  void Answer(Task& task);
  void WritePage(Task& task, std::int64_t horizon_ns, std::int64_t idle_until_ns);
  void Resume(Task& task);
  void GoOnBesideWoken();
  bool HasMadeCall(Task& task, int* turns);
  bool GivesUpStart(Task& task, int turns);
  void AwaitStop(Task& task);
  std::int64_t NsToLook(Task& task);
  std::int64_t OwnHorizonNs() const;
  void Settle(Task& task);
  bool TakeIpcNotesOf(Task& task);
  void TakeOutUntold(Task& task, const shm::ClockReading& before, std::int64_t asked_ns);
  void StepAside(Task& task);
  void WakeSpinners();
  std::int64_t WrittenAt() const { return run_.WrittenAt(); }

  // By the kind of descriptor (handlers.cc).
  void RegisterHandlers();
  Reactor::Found OnPipe(Subject process, std::uint32_t events, Moment moment);
  Reactor::Found OnListener(Subject listener, std::uint32_t events, Moment moment);
  Reactor::Found OnConnection(Subject subject, std::uint32_t events, Moment moment);
  Reactor::Found OnProcessEnd(Subject process, std::uint32_t events, Moment moment);
  Reactor::Found OnAwaited(Subject subject, std::uint32_t events, Moment moment);
  Reactor::Found OnUnknownChildEnd(Subject child, std::uint32_t events, Moment moment);
  Reactor::Found OnTrap(Subject subject, std::uint32_t events, Moment moment);
  Reactor::Found OnCommand(Subject channel, std::uint32_t events, Moment moment);
  Reactor::Found OnSignal(Subject subject, std::uint32_t events, Moment moment);
  Reactor::Found OnGraceRanOut(Subject subject, std::uint32_t events, Moment moment);
  Reactor::Found OnDetector(Subject subject, std::uint32_t events, Moment moment);
  Reactor::Found OnDetectorEnd(Subject subject, std::uint32_t events, Moment moment);

  // Notifications (notifications.cc). True: as TakeNotifications.
  bool Handle(Task& task, const shm::Notification& note);
  static std::int64_t WaitDeadlineOf(const Task& task, const shm::Notification& note);

  // Those who wait to take from the same descriptor (one_waiter.cc).

  bool Yield(Task& task);  // as Handle
  void NoteSpawnedThread(Task& creator, const shm::Notification& note);
  void NoteSpawnedProcess(Task& parent, pid_t pid);

  // Children that are stopped and go on (stops.cc).

  // The robot's scheduler, as threads set it (scheduling.cc). Results: 0, or negative for an errno.

  // System calls that the kernel hands over (trapped.cc). Results as the kernel's: negative for an
  // errno.
  Reactor::Found TrapArrived(int listener, Moment moment);
  Reactor::Found TakeTrapped(const TrappedCall& call, Moment moment);
  void ExitThread(Task& task, const TrappedCall& call);
  bool HandleTrapped(Task& task, const TrappedCall& call);
  void InterruptTrappedWait(Task& task);
  void FinishTrappedWait(Task& task, shm::WakeReason reason);
  void HandleStranger(const TrappedCall& call, Moment moment);
  void ReleaseTrapped();

  // Those that could be about tcsim's own processes (guarded_calls.cc).
  bool IsGuarded(pid_t pid) const;
  bool MeansGuarded(pid_t caller, pid_t receiver) const;
  std::int64_t SignalOurs(pid_t caller, pid_t receiver, int signal) const;
  std::optional<std::int64_t> InsteadOfKernel(const TrappedCall& call) const;
  void LetThrough(const TrappedCall& call) const;
  void ContinueTrap(const Task& task) const;

  // Those other than futex (raw_calls.cc).
  bool HandleRawCall(Task& task, const TrappedCall& call);
  std::int64_t ReadRawClock(const Task& task, const TrappedCall& call);
  std::int64_t SleepRaw(Task& task, const TrappedCall& call);
  void SignalRaw(Task& task);
  void HoldRaw(Task& task, shm::NotificationKind kind);
  std::int64_t PollRaw(Task& task, const TrappedCall& call);
  bool RawTimeout(Task& task, const TrappedCall& call, std::int64_t* ns);
  static std::optional<std::vector<shm::WaitFd>> RawWaitFds(const Task& task,
                                                            const TrappedCall& call);
  static std::uint64_t RawAwaitedSignals(const Task& task, const TrappedCall& call);
  void ClearRawResult(const Task& task, const TrappedCall& call);
  void ForgetNews(const Process& parent);
  void AwaitChildRaw(Task& task, const TrappedCall& call);

  // Those to the robot's scheduler (raw_scheduling.cc).

  // Those that transfer data (raw_transfers.cc).
  void TransferRaw(Task& task, const TrappedCall& call);
  static bool Receives(const TrappedCall& call);

  // Locks of files (wait_queues.cc).
  void LockRaw(Task& task);

  // Timers (raw_timers.cc).

  // Others that they concern (follow_ups.cc).
  void DoFollowUp(Task& task, Moment call, bool last);

  // Those that are (futex.cc).

  // Several at once, and from a condition to its lock (futex_queues.cc).

  // Those that are locks with an owner (lock_futex.cc).

  // Kernel objects that cannot be polled (wait_queues.cc).

  // Signals that clients send, and waits for signals (signals.cc).
  bool PollWhileRunning(Task& task, std::int64_t timeout_ns);

  // Timers (timers.cc); the rules are ProcessTimers'.
  // True: it has written to a timer descriptor.

  // Their signals (timer_signals.cc).

  // Events (events.cc). `timeout_ns` is real; negative: none. What is found happens at `moment`, or
  // at the time that the running thread has come to.
  Reactor::Found PollEvents(std::int64_t timeout_ns, Moment moment);
  Reactor::Found TakeEvents(std::int64_t timeout_ns, Moment moment, bool is_rest);
  Reactor::Found WakeReadyAwaiters(Moment moment);
  // They look again where what is waited for may be there already, and be found at this very
  // moment.
  Reactor::Found TakeNotifications(const Process& process, Moment moment);
  Reactor::Found NotificationArrived(Task& task, Moment moment);
  bool BlockedInKernel();
  bool CutsOff(Task& task);
  void DetectorEnded();
  void LookAtDetector();
  void Accept(const Listener& listener);
  void AddConnection(Connection connection);
  bool RegistersLater(const Connection& connection, pid_t* tid) const;
  void RegisterUnannounced(Moment moment);
  void TakeUpRegistration(const Task& task);
  bool Attach(int connection, Process& client, Moment moment);
  void GiveDdsArea(int connection, pid_t pid);
  void PlaceAtGate(Task& task, std::int64_t at_ns);
  Task* TaskFor(pid_t pid, pid_t tid, Process& client, Moment moment);
  void ProcessEnded(std::size_t index, Moment moment);
  Task* NewTask(pid_t pid, pid_t parent, Robot* robot, const std::string& name, int priority,
                std::int64_t deadline_ns, std::int64_t at_ns, const Process* maker = nullptr);
  Task* NewChild(pid_t pid, pid_t parent, const Process& maker, std::int64_t at_ns);
  Task* AddTask(Process& process, pid_t tid, std::int64_t at_ns);
  Task* AddThread(Process& process, pid_t tid, std::int64_t at_ns);
  bool EndThreadsLostInExec(pid_t pid, Moment moment);
  bool HasExited(const Task& task) const;
  void LetDie(const Process& process);
  void LendLevel();
  Process* LivingProcess(pid_t pid) const { return table_.LivingProcess(pid); }
  Task* KnownTask(pid_t tid) const { return table_.Living(tid); }
  Task& TaskAt(int order) { return table_.At(order); }
  void EndTask(Task& task, Moment moment);

  // Where only gates keep threads from running (gates_only.cc).
  using Late = std::function<Reactor::Found(Moment)>;
  bool PutOff(const Task* by, Late late);
  bool MayGoOn(const Task& task);
  Reactor::Found EndCall(Reactor::Found found);
  Reactor::Found TakePutOff(Moment moment);

  // The last signal and the time to obey it (grace.cc).
  void EndClients();
  void BeginGrace();
  void LimitRealTime();
  void KillOverdue();
  bool IsGraceOver() const { return grace_ran_out_ || stop_.insists(); }
  int StopSignalOf(const Process& process) const;
  static std::int64_t GraceOf(const Process& process);
  std::int64_t KillTimeOf(const Process& process) const;
  void WarnOfKill(const Process& process, const std::string& within);

  // The end (finish.cc).
  void Shutdown();
  void Report(RunReport* report);
  ClientReport ReportOf(const Launch& launch);
  void WarnOfEndsThatDidNotMeet();

  void Warn(const std::string& text) { run_.Warn(text); }
  bool IsInGrace() const { return run_.IsInGrace(); }
  bool WorldGoesOn() const { return world_.present() && !IsInGrace(); }
  bool IsFixed() const { return run_.IsFixed(); }
  bool IsCallback() const { return run_.IsCallback(); }
  static shm::ThreadSlot& Slot(const Task& task) { return SlotOf(task); }

  RunState run_;
  const Scenario& scenario_ = run_.scenario;
  const RunOptions& options_ = run_.options;
  RunReport& report_ = run_.report;
  TaskTable& table_ = run_.table;
  std::deque<Robot>& robots_ = run_.robots;
  std::deque<VirtualCpu>& cpus_ = run_.cpus;
  TemporalConsistency& root_ = run_.root;
  Turn& turn_ = run_.turn;
  shm::RunHeader*& header_ = run_.header;
  const bool& gates_only_ = run_.gates_only;
  std::int64_t& end_ns_ = run_.end_ns;
  std::int64_t& latest_ns_ = run_.latest_ns;
  StopRequest& stop_ = run_.stop;
  std::int64_t& grace_began_ns_ = run_.grace_began_ns;
  World world_{[this](const std::string& text) { Warn(text); }};
  Activations activations_;
  RunRecords records_{run_, world_, activations_};
  Waker waker_{run_, activations_};
  std::vector<Launch> launches_;  // of all clients, as in the scenario
  Reactor reactor_;
  std::unique_ptr<Executor> executor_;
  HostCpu host_cpu_;
  RunClock clock_;
  // What programs ask for, and what they wait for.
  PriorityInheritance inheritance_{run_, waker_};
  DdsGateway dds_{run_, waker_, world_, inheritance_};
  SchedulingCalls scheduling_{run_, waker_, inheritance_};
  RawScheduling raw_scheduling_{run_, scheduling_};
  FutexWords words_{run_, waker_};
  LockFutexes locks_{run_, waker_, words_, inheritance_};
  FutexCalls futexes_{run_, waker_, words_, locks_};
  SignalWakes signal_wakes_{run_, waker_, host_cpu_.active()};
  ChildStops stops_{run_, waker_, signal_wakes_, host_cpu_.active()};
  SignalCalls signals_{run_,
                       waker_,
                       signal_wakes_,
                       stops_,
                       clock_,
                       [this](const Process& process, std::int64_t at_ns) {
                         dds_.NoteWhetherStopped(process, at_ns);
                       }};
  TimerSignals timer_signals_{run_, waker_, signal_wakes_};
  TimerCalls timers_{run_, waker_, timer_signals_};
  RawTimers raw_timers_{run_, timers_};
  DescriptorWaits descriptors_{reactor_};
  SharedEvents shared_events_{run_, waker_, reactor_};
  KernelObjectWaits objects_{run_, waker_};
  std::vector<std::unique_ptr<ProcessLink>> ended_links_;  // until nobody can look there any more
  std::deque<Connection> connections_;
  std::map<pid_t, Connection> early_connections_;  // of threads that register later

  CpuClaim claim_;
  std::vector<Task*> ready_awaiters_;  // whose descriptors have become ready just now
  shm::RunMemory* memory_ = nullptr;
  UniqueFd memfd_, signal_fd_;
  SlotCheck slot_check_{run_.IsFixed(), [this] { return clock_.NsAt(host_cpu_.stop_tsc()); }};
  UsageBook usage_{table_, slot_check_};
  Expulsion expulsion_{run_, waker_, host_cpu_};
  UnmanagedThreads unmanaged_{run_};
  UnknownChildren unknown_children_{table_, reactor_, unmanaged_};
  StandstillWatch standstill_{run_, unmanaged_, unknown_children_};
  // Of the running thread, where there are only gates: it says that a call begins, and may go on.
  bool says_call_ = false, opens_gate_ = false;
  std::vector<Late> put_off_;
  std::vector<pid_t> guarded_;  // tcsim's own processes, this one and the detector among them
  std::vector<Listener> listeners_;
  std::vector<UniqueFd> traps_;  // of clients, where their calls and their children's arrive
  std::string socket_name_;      // of the first; the others' have their numbers in them

  bool reached_end_ = false;
  UniqueFd grace_timer_;                                   // of real time:
  bool grace_ran_out_ = false;                             // it has
  std::int64_t idle_at_ns_ = -1, idle_since_real_ns_ = 0;  // since when nobody acts by itself
  bool has_spinners_ = false;                              // threads that stepped aside

  int shows_ = 0;

  std::uint64_t next_look_tsc_ = 0;
};

}  // namespace tcs
