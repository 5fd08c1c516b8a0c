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
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "coordinator/calls/futex_table.h"
#include "coordinator/core/activations.h"
#include "coordinator/core/coordinator.h"
#include "coordinator/core/moment.h"
#include "coordinator/core/reactor.h"
#include "coordinator/core/task_table.h"
#include "coordinator/core/turn.h"
#include "coordinator/core/world.h"
#include "coordinator/dds/hub.h"
#include "coordinator/dds/own_endpoints.h"
#include "coordinator/dds/topic_log.h"
#include "coordinator/host/executor.h"
#include "coordinator/host/host_cpu.h"
#include "coordinator/host/meter.h"
#include "coordinator/os/cpu_claim.h"
#include "coordinator/os/stop_request.h"
#include "coordinator/os/strays.h"
#include "coordinator/policy/temporal_consistency.h"
#include "coordinator/record/recording.h"
#include "coordinator/trace/schedule_records.h"
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
  std::int64_t EarliestWake() const;
  void NoteLateness(const Task& woken, std::int64_t sent_ns, bool goes_first);
  bool IsSafe(const Task& task) const;
  void PollUnseen();
  bool StrangersRun();
  void WaitOutside();
  bool AwaitOutside();
  std::int64_t FurthestNs() const;
  void LookAround();
  void ShowProgress();

  // What a user is told who sees nothing happen (standstill.cc).
  void LookForStandstill();
  void NoteStandstill(std::int64_t now_ns);
  void NoteLeftBehind(std::int64_t now_ns);
  bool AwaitsTerminal() const;
  std::vector<std::string> WhatIsAwaited() const;
  std::vector<std::string> ComputingStrangers() const;
  std::pair<int, std::string> WhatItAwaits(const Task& task) const;
  std::string AwaitedDescriptors(const Task& task, const awaited::Descriptors& wait) const;

  // States (engine.cc). Whoever changes what a robot could do next refreshes it.
  static bool IsRunnable(const Task& task);
  bool HasRunOut(const Task& task, std::int64_t now_ns) const;
  static ProgramTime OwnDeadlineOf(const Task& task);
  RobotScheduler::Wait WaitOf(const Task& task) const;
  void SetState(Task& task, TaskState state, bool goes_first = false);
  void Requeue(Task& task, bool goes_first = false);
  void Refresh(Robot& robot);
  void MakeReady(Task& task, shm::WakeReason reason, Moment moment);

  // Waits (waits.cc): their one beginning and end.
  void EnterWait(Task& task, Wait wait);
  void LeaveWait(Task& task);
  void ShowObjectWaiters();

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
  void TakeOutUntold(Task& task, const shm::ClockReading& before, std::int64_t asked_ns);
  void StepAside(Task& task);
  void WakeSpinners();
  static std::int64_t HostClockOf(Task& task);
  static Meter::CpuClock CpuClockOf(Task& task) {
    return [&task] { return HostClockOf(task); };
  }
  std::int64_t WrittenAt() const;

  // What shared memory says that cannot be (impossible.cc). Sentences go on after "has ... (".
  static constexpr const char* kWrongIpcNotes = "times of System V objects";
  const char* WhatIsImpossible(const Task& task) const;
  static const char* WhatIsImpossible(const shm::Notification& note);
  void Expel(Process& process, const char* what);
  void AwaitDeath(Task& task);
  std::int64_t StolenOf(const Task& task) const;
  std::int64_t StalenessOf(const Task& task) const;
  bool TakeIpcNotes(Task& task);  // ipc_notes.cc

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

  // Children that nobody announced (unknown_children.cc).
  void FindUnknownChildren(Process& parent);
  void UnknownChildEnded(pid_t pid, Moment moment);
  bool HasUnknownChild(const Process& parent) const;
  bool AwaitsUnknownChildren() const;
  bool UnknownChildrenRun() const;

  // Threads that nobody announced, or that do not end (unknown_threads.cc).
  void LowerUnknownThreads();
  void Lower(pid_t tid);
  bool NeverRegisters(Task& task);
  bool IsAstray(pid_t tid) const;
  std::string NameOfMakerOf(pid_t tid);

  // The robot's scheduler, as threads set it (scheduling.cc). Results: 0, or negative for an errno.
  void HandleScheduling(Task& asking, const shm::Notification& note);
  static RobotScheduler& SchedulerOf(const Task& task) { return task.process->robot->scheduler; }
  static const SchedulingParameters& ParametersOf(const Task& task) {
    return SchedulerOf(task).ParametersOf(task.order);
  }
  static RobotScheduler::Priority PriorityOf(const Task& task) {
    return SchedulerOf(task).PriorityOf(task.order);
  }
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

  // Programs that speak DDS (dds.cc).
  std::string OpenDds();
  std::string CloseDds();
  dds::Speaker WhoIs(dds::Hub::Number number) const;
  void WarnOfDrops();
  void NoteWhetherStopped(const Process& process, std::int64_t at_ns);
  void TakeOwnMessages();
  void HandleDds(Task& task, const shm::Notification& note, std::int64_t deadline_ns);
  void JoinDds(Task& task);
  void SendDds(Process& process, std::size_t bytes, std::int64_t at_ns);
  void WarnOfSockets(const Process& process, shm::WhySockets why);
  void LeaveDds(Process& process, Moment moment);
  void AwaitMessages(Task& task);
  bool IsDelivering(const Process& process, std::int64_t now_ns) const;
  void ReleaseThoseAwaitingDeliverer(const Process& process, Moment moment);
  void ReleaseThoseAwaitingRoom(std::uint32_t number, Moment moment);
  void ShowDeliverersTheirDeadlines();
  void HandMessagesOver(Task& task);

  // Signals that clients send, and waits for signals (signals.cc).
  void WakeSignalled(pid_t receiver, Moment moment);
  void WakeForSignals(Process& process, Moment moment);
  void AnswerAhead(Task& task);
  bool EndAwait(Task& task, const SignalSets& sets, Moment moment);
  bool PollSignals();
  bool HasSignalForTrapped(Task& task) const;
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
  Task* TakerOf(const Process& process, const TimerSignal& signal) const;
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
  bool MayGoOn(Task& task);
  bool Preempts() const { return gates_only_ && !IsFixed(); }
  void BringToGate(Task& task);
  SignalSets SignalsOf(Task& task) const;
  void ChargeUndispatched(Task& task);
  Reactor::Found EndCall(Reactor::Found found);
  Reactor::Found TakePutOff(Moment moment);

  // What is written about the run (records.cc).
  std::string OpenRecords();
  void FlushRecords();
  std::string CloseRecords();
  void RecordRun(const Task& task, DispatchLog::Span shown, DispatchLog::Span world);

  // What clients have used (usage.cc).
  std::int64_t ChargedTo(const Process& process) const;
  std::int64_t ChargedToAllOf(const Process& client) const;
  Usage UsageOf(const Process& process);
  Usage UsageOfAll(const Process& client);
  std::int64_t HostCpuOf(Task& task);
  void KeepUsageOf(Task& ended);
  void KeepUsageOf(Process& ended);

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

  void Warn(const std::string& text);
  bool IsInGrace() const { return grace_began_ns_ != shm::kNeverNs; }
  bool WorldGoesOn() const { return world_.present() && !IsInGrace(); }
  bool IsFixed() const { return options_.accounting == shm::Accounting::kFixed; }
  bool IsCallback() const { return options_.sync == shm::Sync::kCallback; }
  shm::ThreadSlot& Slot(const Task& task) const { return *task.slot_memory; }

  const Scenario scenario_;
  const RunOptions options_;
  CommandInput command_input_{[this](const std::string& text) { Warn(text); }};
  World world_{command_input_};
  TemporalConsistency root_;
  ScheduleRecords schedule_;
  Activations activations_;
  int world_row_ = 0;
  std::deque<Robot> robots_;
  std::vector<Launch> launches_;  // of all clients, as in the scenario
  std::deque<VirtualCpu> cpus_;   // of all robots, by leaf
  TaskTable table_;
  FutexTable futexes_{[this](int order) { return PriorityOf(TaskAt(order)); }};
  dds::Hub hub_;
  dds::OwnEndpoints ends_{hub_};
  dds::TopicLog topic_log_{[this](dds::Hub::Number number) { return WhoIs(number); }};
  std::optional<record::Recording> recording_;
  std::vector<Process*> dds_processes_;                    // that have joined it
  std::vector<std::unique_ptr<ProcessLink>> ended_links_;  // until nobody can look there any more
  std::deque<Connection> connections_;
  std::map<pid_t, Connection> early_connections_;  // of threads that register later
  int unseen_ = 0;                                 // threads in TaskState::kUnseen
  WaitCounts wait_counts_;
  std::map<pid_t, UnknownChild> unknown_children_;  // the living
  std::set<pid_t> untaken_children_;  // those that have ended, and were not waited for yet
  std::uint64_t next_signal_look_tsc_ = 0;

  CpuClaim claim_;
  Reactor reactor_;
  std::vector<Task*> ready_awaiters_;  // whose descriptors have become ready just now
  shm::RunMemory* memory_ = nullptr;
  shm::RunHeader* header_ = nullptr;  // in it
  UniqueFd memfd_, signals_;
  WaitQueues queues_;
  std::uint32_t wait_counter_ = 0;
  std::uint64_t fds_order_counter_ = 0;
  bool gates_only_ = false;  // there is no right to real-time priorities
  std::unique_ptr<Executor> executor_;
  HostCpu host_cpu_;
  Turn turn_;
  // Of the running thread, where there are only gates: it says that a call begins, and may go on.
  bool says_call_ = false, opens_gate_ = false;
  std::vector<Late> put_off_;
  std::vector<pid_t> guarded_;  // tcsim's own processes, this one and the detector among them
  // Unknown threads that have lost their level; time waits for them until their CPU clocks show it.
  std::map<pid_t, std::int64_t> lowered_;
  struct UnknownThreads {
    std::int64_t dispatch = -1;             // in which they were seen,
    std::map<pid_t, std::int64_t> used_ns;  // and what they had used by then
  };
  UnknownThreads unknown_threads_;
  int most_pids_ = MostPids();
  std::vector<Listener> listeners_;
  std::vector<UniqueFd> traps_;  // of clients, where their calls and their children's arrive
  std::string socket_name_;      // of the first; the others' have their numbers in them
  std::uint64_t ns_per_tick_q32_ = 0;
  double ticks_per_ns_ = 1.0;

  std::int64_t end_ns_ = 0;
  // When the last thing has happened, and when happens what comes from elsewhere while nobody acts.
  std::int64_t latest_ns_ = 0;
  StopRequest stop_;
  bool reached_end_ = false;
  std::int64_t grace_began_ns_ = shm::kNeverNs;
  UniqueFd grace_timer_;                                   // of real time:
  bool grace_ran_out_ = false;                             // it has
  std::int64_t idle_at_ns_ = -1, idle_since_real_ns_ = 0;  // since when nobody acts by itself
  bool has_spinners_ = false;                              // threads that stepped aside

  RunReport report_;
  std::int64_t client_host_ns_ = 0;
  VirtualDuration most_lead_;  // of all programs' clocks
  std::int64_t start_real_ns_ = 0, start_cpu_ns_ = 0;
  std::uint64_t start_tsc_ = 0;
  int shows_ = 0;

  struct Standstill {
    std::int64_t dispatches = -1, at_ns = -1;  // virtual
    std::int64_t since_ns = 0;                 // real
  };
  Standstill standstill_;
  std::uint64_t next_look_tsc_ = 0;
  std::int64_t alone_since_ns_ = -1;  // real
  bool has_said_standstill_ = false, has_said_left_behind_ = false;
};

}  // namespace tcs
