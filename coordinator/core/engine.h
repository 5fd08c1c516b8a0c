// The engine: its parts, how they are set up and told of each other (setup.cc), the loop and the
// choice of who acts (engine.cc), the dispatch of a thread and its charge (dispatch.cc), what the
// kernel says meanwhile (events.cc, handlers.cc), what clients say (notifications.cc), and the end
// (end.cc).
#pragma once

#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "coordinator/calls/futex_table.h"
#include "coordinator/core/activations.h"
#include "coordinator/core/births.h"
#include "coordinator/core/coordinator.h"
#include "coordinator/core/dds_gateway.h"
#include "coordinator/core/deaths.h"
#include "coordinator/core/expulsion.h"
#include "coordinator/core/grace.h"
#include "coordinator/core/held_threads.h"
#include "coordinator/core/launches.h"
#include "coordinator/core/moment.h"
#include "coordinator/core/reactor.h"
#include "coordinator/core/registration.h"
#include "coordinator/core/registration_sockets.h"
#include "coordinator/core/run_clock.h"
#include "coordinator/core/run_records.h"
#include "coordinator/core/run_reporter.h"
#include "coordinator/core/run_state.h"
#include "coordinator/core/slot_check.h"
#include "coordinator/core/standstill_watch.h"
#include "coordinator/core/trap_listeners.h"
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
  std::string PrepareSignals();
  std::string PrepareHostCpu();
  void MakeRobots();
  void TellOfWaits();
  void TellOfEnds();

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

  // The door (waker.h).
  void SetState(Task& task, TaskState state) { waker_.SetState(task, state); }
  void Refresh(Robot& robot) { waker_.Refresh(robot); }
  void MakeReady(Task& task, shm::WakeReason reason, Moment moment) {
    waker_.Wake(task, reason, moment);
  }
  void EnterWait(Task& task, Wait wait) { waker_.Wait(task, std::move(wait)); }

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
  awaited::Descriptors Watch(const Task& task, const shm::WaitFd* fds, std::size_t count);
  awaited::Descriptors WatchAsAsked(Task& task, const shm::Notification& note);
  void GoBehind(Task& task, awaited::Descriptors& watched);

  // Those who wait to take from the same descriptor (one_waiter.cc).
  void WakeAwaiters(const std::vector<Task*>& awaiters, Moment moment);
  void PassOver(Task& task, Task& first);
  void PassOn(Task& first, Moment moment);

  bool Yield(Task& task);  // as Handle
  void NoteSpawnedThread(Task& creator, const shm::Notification& note);
  void NoteSpawnedProcess(Task& parent, pid_t pid);
  void EndWatches(const awaited::Descriptors& watched);
  static Subject SubjectOfWait(const Task& task, const awaited::Descriptors& watched);

  // Children that are stopped and go on (stops.cc).
  void LetStop(const Process& process);
  void LetGoOn(const Process& process);
  void NoteStops(Process& process, Moment moment);
  void ChildChanged(Process& parent, pid_t child, bool by_stop, Moment moment);
  void LookAtStops(Moment moment);

  // The robot's scheduler, as threads set it (scheduling.cc). Results: 0, or negative for an errno.
  void HandleScheduling(Task& asking, const shm::Notification& note);
  static std::int64_t MaySchedule(const Task& asking, const Task& task,
                                  const SchedulingParameters& wanted);
  std::int64_t Schedule(const Task& asking, Task& task, const SchedulingParameters& wanted);
  static std::int64_t MayPrioritize(const Task& asking, const Task& task, std::int64_t policy,
                                    std::int64_t priority);
  std::int64_t SetPriority(const Task& asking, Task& task, std::int64_t policy,
                           std::int64_t priority);
  std::int64_t SetAffinity(const Task& asking, Task& task, std::uint64_t cores);
  void InheritScheduling(Task& task, const Task& creator);
  void FindPriority(Task& task);
  static void BlockOn(Task& task, const Task* owner);
  void LeaveLock(Task& task);

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
  std::int64_t ScheduleRaw(Task& task, const TrappedCall& call);
  std::int64_t SetSchedulingRaw(Task& task, Task& of, const TrappedCall& call);
  std::int64_t GetSchedulingRaw(Task& task, Task& of, const TrappedCall& call);
  std::int64_t SetAttributesRaw(Task& task, Task& of, const TrappedCall& call);
  std::int64_t GetAttributesRaw(Task& task, const Task& of, const TrappedCall& call);

  // Those that transfer data (raw_transfers.cc).
  void TransferRaw(Task& task, const TrappedCall& call);
  static bool Receives(const TrappedCall& call);

  // Locks of files (wait_queues.cc).
  void LockRaw(Task& task);
  bool LookAtKernelWaits(Moment moment);

  // Timers (raw_timers.cc).
  struct FoundTimer {
    Process* owner = nullptr;
    std::int64_t id = 0;
  };
  void HandleRawTimer(Task& task, const TrappedCall& call);
  std::int64_t CreateTimerRaw(Task& task, const TrappedCall& call);
  FoundTimer FindTimerFd(const Task& task, int number);
  static FoundTimer AdoptTimerFd(const Task& task, int number);
  std::int64_t TimerNow(const Task& task, const Process& owner, const shm::TimerKind& kind) const;
  itimerspec ExchangeTimer(Task& task, const FoundTimer& found, bool sets, std::int64_t first_ns,
                           std::int64_t interval_ns);
  std::int64_t SetTimerRaw(Task& task, const FoundTimer& found, const TrappedCall& call);
  std::int64_t ItimerRaw(Task& task, const TrappedCall& call);
  std::int64_t PosixTimerRaw(Task& task, const TrappedCall& call);

  // Others that they concern (follow_ups.cc).
  void DoFollowUp(Task& task, Moment call, bool last);

  // Those that are (futex.cc).
  void HandleFutex(Task& task, const TrappedCall& call);
  bool HoldsToWake(Task& task, const TrappedCall& call, int command);
  std::int64_t CarryOutWake(const Process& process, const TrappedCall& call, Moment moment);
  std::int64_t FutexDeadline(const Task& task, const TrappedCall& call, int command,
                             const timespec& timeout, std::int64_t* deadline_ns);
  static std::int64_t WrongFutexCall(const Task& task, const TrappedCall& call, int command);
  std::int64_t FutexWait(Task& task, const TrappedCall& call, int command);
  std::int64_t FutexWake(const FutexKey& key, std::int64_t most, std::uint32_t bits, Moment moment);
  std::int64_t FutexRequeue(const Task& task, const TrappedCall& call, int command);
  std::int64_t FutexWakeOp(const Task& task, const TrappedCall& call);
  bool IsEnding(const Task& joiner, pid_t tid) const;
  FutexKey FutexKeyFor(const Task& task, const TrappedCall& call, std::uint64_t address);
  FutexKey WokenKeyFor(const Process& process, const TrappedCall& call,
                       std::uint64_t address) const;
  void EnterFutexWait(Task& task, awaited::Futex wait, std::int64_t deadline_ns);
  Task* MostUrgentWaiter(const FutexKey& key, std::uint32_t bits);

  // Several at once, and from a condition to its lock (futex_queues.cc).
  std::int64_t FutexWaitForAny(Task& task, const TrappedCall& call);
  std::int64_t FutexWaitForLock(Task& task, const TrappedCall& call);
  std::int64_t FutexRequeueToLock(Task& task, const TrappedCall& call);
  void RequeueToLock(Task& waiter, const FutexKey& lock, Task& owner);

  // Those that are locks with an owner (lock_futex.cc).
  std::int64_t FutexLock(Task& task, const TrappedCall& call, int command);
  std::int64_t FutexUnlock(Task& task, const TrappedCall& call);
  bool HandLockOn(const FutexKey& key, std::uint32_t flags, Moment moment);
  void WakeThoseWaitingFor(Task& ended, Moment moment);

  // Kernel objects that cannot be polled (wait_queues.cc).
  void WaitAtQueue(Task& task, const shm::Notification& note, std::int64_t deadline_ns);
  bool WakeQueue(std::int64_t kind, std::int64_t id, Moment moment);
  void WakeEveryQueue(Moment moment);
  void FlushTerminals();

  // Signals that clients send, and waits for signals (signals.cc).
  void WakeSignalled(pid_t receiver, Moment moment);
  void WakeForSignals(Process& process, Moment moment);
  void AnswerAhead(Task& task);
  bool EndAwait(Task& task, const SignalSets& sets, Moment moment);
  bool PollSignals();
  bool HasSignalForTrapped(const Task& task) const;
  bool PollWhileRunning(Task& task, std::int64_t timeout_ns);

  // Timers (timers.cc); the rules are ProcessTimers'.
  // True: it has written to a timer descriptor.
  bool SetTimerOf(Process& process, Task& task, const shm::Notification& note);
  void FireDue(Robot& robot, std::int64_t now_ns);
  bool Expire(Process& process, std::int64_t now_ns);
  bool BringUpToDate(Process& owner, const Task& asking, std::int64_t id);
  void ExpireCpuTimers(const Task& ran);
  ProcessTimers::CpuUsed CpuUsedBy(const Task& task) const;
  static UniqueFd TimerDescriptorOf(const Process& process, int number);
  static void CreateTimer(Task& task, const shm::Notification& note);
  static void DeleteTimer(Process& process, std::int64_t id);
  static void DeletePosixTimers(Process& process);

  // Their signals (timer_signals.cc).
  static pid_t AccepterOf(const Process& process, const TimerSignal& signal);
  static Task* TakerOf(const Process& process, const TimerSignal& signal);
  void RouteTimerSignals(Process& process, Moment moment);
  void SendTimerSignalsTo(const Task& task);
  static void NoteAccepted(Process& process);

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
  Process* LivingProcess(pid_t pid) const { return table_.LivingProcess(pid); }
  Task* KnownTask(pid_t tid) const { return table_.Living(tid); }
  Task& TaskAt(int order) { return table_.At(order); }

  // Where only gates keep threads from running (gates_only.cc).
  using Late = std::function<Reactor::Found(Moment)>;
  bool PutOff(const Task* by, Late late);
  bool MayGoOn(const Task& task);
  Reactor::Found EndCall(Reactor::Found found);
  Reactor::Found TakePutOff(Moment moment);

  // The end (end.cc).
  void EndClients();
  void BeginGrace();
  void Shutdown();

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
  CommandInput command_input_{[this](const std::string& text) { Warn(text); }};
  World world_{command_input_};
  Activations activations_;
  RunRecords records_{run_, world_, activations_};
  Waker waker_{run_, activations_};
  FutexTable futexes_{[this](int order) { return PriorityOf(TaskAt(order)); }};
  DdsGateway dds_{run_, waker_, world_};
  std::uint64_t next_signal_look_tsc_ = 0;

  CpuClaim claim_;
  Reactor reactor_;
  std::vector<Task*> ready_awaiters_;  // whose descriptors have become ready just now
  shm::RunMemory* memory_ = nullptr;
  UniqueFd memfd_, signals_;
  WaitQueues queues_;
  std::uint32_t wait_counter_ = 0;
  std::uint64_t fds_order_counter_ = 0;
  std::unique_ptr<Executor> executor_;
  HostCpu host_cpu_;
  HeldThreads held_{run_, host_cpu_};
  RunClock clock_;
  // What is believed of a client, what it has used, and how it is ended for what it writes.
  SlotCheck slot_check_{run_.IsFixed(), [this] { return clock_.NsAt(host_cpu_.stop_tsc()); }};
  UsageBook usage_{table_, slot_check_};
  Expulsion expulsion_{run_, waker_, host_cpu_};
  // Threads and processes that come and go.
  Births births_{run_, waker_, reactor_, records_};
  Deaths deaths_{run_, waker_, reactor_, host_cpu_, usage_};
  TrapListeners traps_{reactor_};
  RegistrationSockets sockets_{reactor_};
  Registration registration_{{run_, waker_, reactor_, host_cpu_, sockets_, births_, deaths_, dds_},
                             [this](Process& process, Moment moment) {
                               DeletePosixTimers(process);
                               dds_.Leave(process, moment);
                             }};
  Launches launches_{run_, waker_, births_, sockets_, traps_, guarded_};
  UnmanagedThreads unmanaged_{run_};
  UnknownChildren unknown_children_{table_, reactor_, unmanaged_};
  // What users are told, and the end.
  StandstillWatch standstill_{run_, unmanaged_, unknown_children_};
  Grace grace_{run_, reactor_, unknown_children_,
               [this](Moment moment) { WakeSignalled(0, moment); }};
  RunReporter reporter_{run_, {clock_, world_, command_input_, usage_, launches_, dds_.records()}};
  // Of the running thread, where there are only gates: it says that a call begins, and may go on.
  bool says_call_ = false, opens_gate_ = false;
  std::vector<Late> put_off_;
  std::vector<pid_t> guarded_;  // tcsim's own processes, this one and the detector among them

  bool reached_end_ = false;
  std::int64_t idle_at_ns_ = -1, idle_since_real_ns_ = 0;  // since when nobody acts by itself
  bool has_spinners_ = false;                              // threads that stepped aside

  int shows_ = 0;

  std::uint64_t next_look_tsc_ = 0;
};

}  // namespace tcs
