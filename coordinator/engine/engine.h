// The engine: its parts, how they are set up and told of each other (setup.cc), the loop and the
// choice of who acts (engine.cc), the dispatch of a thread and its charge (dispatch.cc), on another
// processor (beside.cc), what the
// kernel says meanwhile (events.cc, handlers.cc), when it is held back (keep_pace.cc), what clients
// say (notifications.cc), and the end (end.cc).
#pragma once

#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "coordinator/calls/child_stops.h"
#include "coordinator/calls/datagram_log.h"
#include "coordinator/calls/datagram_queues.h"
#include "coordinator/calls/dds_gateway.h"
#include "coordinator/calls/descriptor_waits.h"
#include "coordinator/calls/follow_ups.h"
#include "coordinator/calls/futex_calls.h"
#include "coordinator/calls/futex_words.h"
#include "coordinator/calls/guarded_calls.h"
#include "coordinator/calls/kept_calls.h"
#include "coordinator/calls/kernel_object_waits.h"
#include "coordinator/calls/local_sockets.h"
#include "coordinator/calls/lock_futexes.h"
#include "coordinator/calls/notifications.h"
#include "coordinator/calls/outside_waits.h"
#include "coordinator/calls/posted_datagrams.h"
#include "coordinator/calls/priority_inheritance.h"
#include "coordinator/calls/raw_calls.h"
#include "coordinator/calls/raw_child_waits.h"
#include "coordinator/calls/raw_draws.h"
#include "coordinator/calls/raw_polls.h"
#include "coordinator/calls/raw_scheduling.h"
#include "coordinator/calls/raw_timers.h"
#include "coordinator/calls/raw_times.h"
#include "coordinator/calls/raw_transfers.h"
#include "coordinator/calls/scheduling_calls.h"
#include "coordinator/calls/shared_events.h"
#include "coordinator/calls/signal_calls.h"
#include "coordinator/calls/signal_wakes.h"
#include "coordinator/calls/spawns.h"
#include "coordinator/calls/timer_calls.h"
#include "coordinator/calls/timer_signals.h"
#include "coordinator/calls/trapped_calls.h"
#include "coordinator/calls/trapped_waits.h"
#include "coordinator/core/computing_ahead.h"
#include "coordinator/core/debugger_hold.h"
#include "coordinator/core/pacing.h"
#include "coordinator/core/run_reporter.h"
#include "coordinator/core/standstill_watch.h"
#include "coordinator/core/state_dump.h"
#include "coordinator/core/turns_beside.h"
#include "coordinator/dump/state_link.h"
#include "coordinator/host/executor.h"
#include "coordinator/host/host_cpu.h"
#include "coordinator/host/meter.h"
#include "coordinator/network/robot_network.h"
#include "coordinator/os/cpu_claim.h"
#include "coordinator/os/cpu_share.h"
#include "coordinator/os/real_time_facts.h"
#include "coordinator/os/stop_request.h"
#include "coordinator/policy/temporal_consistency.h"
#include "coordinator/processes/bare_programs.h"
#include "coordinator/processes/births.h"
#include "coordinator/processes/deaths.h"
#include "coordinator/processes/expulsion.h"
#include "coordinator/processes/grace.h"
#include "coordinator/processes/held_threads.h"
#include "coordinator/processes/launches.h"
#include "coordinator/processes/registration.h"
#include "coordinator/processes/registration_sockets.h"
#include "coordinator/processes/ros_daemon.h"
#include "coordinator/processes/run_records.h"
#include "coordinator/processes/slot_check.h"
#include "coordinator/processes/trap_listeners.h"
#include "coordinator/processes/undispatched_threads.h"
#include "coordinator/processes/unknown_children.h"
#include "coordinator/processes/unmanaged_threads.h"
#include "coordinator/processes/usage_book.h"
#include "coordinator/tasks/activations.h"
#include "coordinator/tasks/coordinator.h"
#include "coordinator/tasks/moment.h"
#include "coordinator/tasks/reactor.h"
#include "coordinator/tasks/run_clock.h"
#include "coordinator/tasks/run_state.h"
#include "coordinator/tasks/waker.h"
#include "coordinator/world/world.h"
#include "shm/attach_protocol.h"
#include "shm/clock_page.h"

namespace tcs {

class Engine {
 public:
  Engine(const Scenario& scenario, const RunOptions& options);
  ~Engine();
  RunReport Run();

 private:
  // Set-up (setup.cc). Empty on success, else one sentence.
  [[nodiscard]] std::string Prepare();
  [[nodiscard]] std::string TakeCpu();
  int HomeCpu() const;
  [[nodiscard]] std::string OpenAnswers();
  void TellOfMissingRights() const;
  [[nodiscard]] std::string PrepareMemory();
  [[nodiscard]] std::string PrepareSignals();
  bool HasSignal() const;
  [[nodiscard]] std::string PrepareHostCpu();
  std::uint64_t CounterRate() const;
  std::optional<std::uint64_t> TurnsSeed() const;
  void MakeRobots();
  void TellOfWaits();
  void TellOfEnds();

  // The loop (engine.cc).
  bool Step();
  bool AwaitDeaths();
  int Living() const;
  VirtualDuration MostHeld() const;
  VirtualDuration LeftToHold(const Task& task) const;
  bool StandsForEver(VirtualCpu& cpu) const;
  void LetWorldGoOnWithout(Task& task);
  void PayDebt(Task& task, VirtualDuration passes);
  void StepCpu(VirtualCpu& cpu);
  bool StepWorld();
  bool StepNetwork();
  void ShowNetwork(VirtualTime progress);
  VirtualTime KeepWorldNear(const Task& task, VirtualTime horizon);
  bool HasJumpedOver();
  VirtualTime HorizonFor(Task& task, VirtualTime* idle_until);
  void ComeBack(Task& task, Moment moment);
  void PollUnseen();
  bool UnmanagedRun();
  void WaitOutside();
  bool StepOutside();
  void ShowOutside();
  void LookAgainAtHidden();
  Moment WhenItCame(Moment moment);
  void WaitForDebugger();
  bool AwaitOutside();
  VirtualTime Furthest() const;
  void LookAround();

  // Holding the run back (keep_pace.cc).
  bool KeepPace();
  void LendProcessor();
  bool HasProcessor();
  VirtualTime NextAct() const;
  HostTime RunningTime() const;
  void FlushForWatchers();

  // Turns on another processor (beside.cc).
  void BeginTurnsBeside();
  void BeginTurnBeside(VirtualCpu& cpu);
  void TakeTurnBeside(Task& task);

  // The dispatch (dispatch.cc).
  void Dispatch(Task& task, VirtualTime horizon, VirtualTime idle_until);
  void TakeAgainIfUnmarked(Task& task);
  bool AnswerEarly(Task& task);
  void BeginTurn(Task& task, VirtualTime horizon, VirtualTime idle_until);
  static void NoteTurnBegins(Task& task);
  void EndTurn(Task& task);
  void TellOthersOf(Task& task, Moment call, bool looks_again);
  void LookForUntoldSignals(const Task& task, Moment stop);
  void Answer(Task& task);
  void GrantWhatIsSafe(const VirtualCpu& cpu, ClockGrant& grant) const;
  std::int64_t ChargedUndispatched(const Task& task) const;
  void WritePage(Task& task, VirtualTime horizon, VirtualTime idle_until);
  void AnswerCall(Task& task);
  void Resume(Task& task);
  void GoOnBesideWoken();
  bool HasMadeCall(Task& task, int* turns);
  bool GivesUpStart(Task& task, int turns);
  void AwaitStop(Task& task);
  HostDuration TimeToLook(Task& task);
  ProgramTime OwnHorizon() const;
  void Settle(Task& task);
  bool TakeNotesOf(Task& task);
  void TakeOutUntold(Task& task, const shm::ClockReading& before, HostDuration asked);
  void ChargeSilence(Task& task);
  void StepAside(Task& task);
  void WakeSpinners();

  // By the kind of descriptor (handlers.cc).
  void RegisterHandlers();
  Reactor::Found OnPipe(Subject process, std::uint32_t events, Moment moment);
  Reactor::Found OnListener(Subject listener, std::uint32_t events, Moment moment);
  Reactor::Found OnConnection(Subject subject, std::uint32_t events, Moment moment);
  Reactor::Found OnProcessEnd(Subject process, std::uint32_t events, Moment moment);
  Reactor::Found OnAwaited(Subject subject, std::uint32_t events, Moment moment);
  Reactor::Found OnOutside(Subject file, std::uint32_t events, Moment moment);
  Reactor::Found OnUnknownChildEnd(Subject child, std::uint32_t events, Moment moment);
  Reactor::Found OnTrap(Subject subject, std::uint32_t events, Moment moment);
  Reactor::Found OnCommand(Subject channel, std::uint32_t events, Moment moment);
  Reactor::Found OnNetwork(Subject robot, std::uint32_t events, Moment moment);
  Reactor::Found OnSignal(Subject subject, std::uint32_t events, Moment moment);
  Reactor::Found OnGraceRanOut(Subject subject, std::uint32_t events, Moment moment);
  Reactor::Found OnDetector(Subject subject, std::uint32_t events, Moment moment);
  Reactor::Found OnDetectorEnd(Subject subject, std::uint32_t events, Moment moment);
  Reactor::Found OnStateAsked(Subject subject, std::uint32_t events, Moment moment);

  // System calls that the kernel hands over (trapped.cc).
  Reactor::Found TrapArrived(int listener, Moment moment);
  Reactor::Found TakeTrapped(const TrappedCall& call, Moment moment);
  void TakeCallsOfNewborns(Moment moment);
  Task* TaskOf(const TrappedCall& call);

  static constexpr HostDuration kNoWait{};  // what is there is looked at, and nothing waited for
  // Events (events.cc). A negative timeout: none. What is found happens at `moment`, or
  // at the time that the running thread has come to.
  Reactor::Found PollEvents(HostDuration timeout, Moment moment);
  bool PollWhileRunning(Task& task, HostDuration timeout);
  Reactor::Found TakeEvents(HostDuration timeout, Moment moment, bool is_rest);
  Reactor::Found WakeReadyAwaiters(Moment moment);
  // They look again where what is waited for may be there already, and be found at this very
  // moment.
  Reactor::Found TakeNotifications(const Process& process, Moment moment);
  Reactor::Found NotificationArrived(Task& task, Moment moment);
  bool PutOffArrival(Task& task);
  bool BlockedInKernel();
  bool CutsOff(Task& task);
  void DetectorEnded();
  void LookAtDetector();

  // Where only gates keep threads from running (gates_only.cc).
  using Late = std::function<Reactor::Found(Moment)>;
  bool PutOff(const Task* by, Late late);
  bool MayGoOn(Task& task);
  void OpenGate(Task& task);
  bool IsSaidBeforeTurn(Task& task, const shm::PipeMessage& message);
  void BringToGate(Task& task);
  Reactor::Found BringOthersToGates(const Task& sender, Moment moment);
  Reactor::Found AwaitSleepAtGates(Moment moment);
  void AwaitHandlers();
  struct WayToGate {
    HostDuration look_every;
    HostDuration most;  // that it takes a thread, by its CPU clock
  };
  Reactor::Found AwaitThreads(Moment moment, const WayToGate& way,
                              const std::function<bool(const Task&)>& is_awaited,
                              const std::function<void(Task&)>& at_first);
  void ChargeUndispatched(Task& task);
  Reactor::Found EndCall(Reactor::Found found);
  Reactor::Found TakePutOff(Moment moment);
  void LeaveCpuIfClaimed();

  // The end (end.cc).
  void EndClients();
  void BeginGrace();
  void Shutdown();

  bool WorldGoesOn() const { return world_.present() && !run_.IsInGrace(); }

  const RealTimeFacts real_time_;
  RunState run_;
  World world_{[this](const std::string& text) { run_.Warn(text); }};
  RobotNetwork network_;
  TemporalConsistency::Leaf network_leaf_ = -1;  // -1: there is no network
  TemporalConsistency::Leaf outside_leaf_ = -1;
  VirtualTime network_progress_;
  AnswerFeed answers_;
  Activations activations_;
  RunRecords records_{run_, world_, activations_};
  Waker waker_{run_, activations_};
  Reactor reactor_;
  std::unique_ptr<Executor> executor_;
  HostCpu host_cpu_;
  HeldThreads held_{run_, host_cpu_};
  UndispatchedThreads undispatched_{run_};
  RunClock clock_;
  Pacing pacing_{run_.options, run_.end, run_.options.on_notice};
  ComputingAhead ahead_{{run_, waker_, host_cpu_, *executor_, clock_, records_},
                        [this](Moment moment) { return PollEvents(kNoWait, moment); }};
  TurnsBeside beside_{{run_, *executor_, clock_, ahead_, records_},
                      [this](Moment moment) { return PollEvents(kNoWait, moment); }};
  // What programs ask for, and what they wait for.
  PriorityInheritance inheritance_{run_, waker_};
  DdsGateway dds_{run_, waker_, world_, inheritance_};
  SchedulingCalls scheduling_{run_, waker_, inheritance_};
  RawScheduling raw_scheduling_{run_, scheduling_};
  FutexWords words_{run_, waker_};
  LockFutexes locks_{run_, waker_, words_, inheritance_};
  FutexCalls futexes_{run_, waker_, words_, locks_,
                      [this](Process* process) { ahead_.StayHome(process); }};
  SignalWakes signal_wakes_{run_, waker_, host_cpu_.active(), undispatched_};
  ChildStops stops_{run_, waker_, signal_wakes_, host_cpu_.active()};
  SignalCalls signals_{
      run_, waker_, signal_wakes_, stops_, clock_, [this](const Process& process, VirtualTime at) {
        dds_.NoteWhetherStopped(process, at);
      }};
  TimerSignals timer_signals_{run_, waker_, signal_wakes_};
  TimerCalls timers_{run_, waker_, timer_signals_};
  RawTimers raw_timers_{run_, timers_};
  Peers peers_{run_};
  OutsideWaits outside_{run_, reactor_, peers_, [this] { return RunningTime(); }};
  DescriptorWaits descriptors_{reactor_, outside_};
  SharedEvents shared_events_{run_, waker_, reactor_};
  LocalSockets local_sockets_{run_};
  DatagramLog datagram_log_;
  DatagramQueues datagrams_{run_, answers_, datagram_log_};
  PostedDatagrams posted_{run_, world_};
  KernelObjectWaits objects_{run_, waker_, [this](Moment moment) {
                               if (WorldGoesOn()) world_.ReceiveFromTerminals(moment.at);
                             }};
  BarePrograms bare_programs_{run_};
  RosDaemon ros_daemon_{run_, peers_};
  GuardedCalls guard_;

  // Who takes part: how threads and processes come, and how they go.
  SlotCheck slot_check_{run_.IsFixed(), [this] { return clock_.NsAt(host_cpu_.stop_tsc()); }};
  UsageBook usage_{run_.table, slot_check_};
  Expulsion expulsion_{run_, waker_, host_cpu_};
  Births births_{run_, waker_, reactor_, records_};
  Deaths deaths_{run_, waker_, reactor_, host_cpu_, usage_};
  TrapListeners traps_{reactor_};
  RegistrationSockets sockets_{reactor_};
  SpinWaits spins_{run_};
  DateCalls dates_{run_, waker_};
  Registration registration_{
      {run_, waker_, reactor_, host_cpu_, sockets_, bare_programs_, births_, deaths_},
      {[this](Process& process, Moment moment) {
         TimerCalls::DeletePosix(process);
         dds_.Leave(process, moment);
       },
       [this](const Process& process) { return dds_.AreaOf(process); }}};
  Launches launches_{run_, waker_, births_, sockets_, traps_, world_, network_, guard_.guarded()};
  UnmanagedThreads unmanaged_{run_};
  UnknownChildren unknown_children_{run_.table, reactor_, unmanaged_};
  Grace grace_{run_, reactor_, unknown_children_,
               [this](Moment moment) { signals_.Sent({}, moment); }};

  Spawns spawns_{run_,
                 {*executor_, births_, registration_, scheduling_, bare_programs_,
                  unknown_children_, unmanaged_}};

  // Calls that are made raw.
  RawTimes raw_times_{run_, waker_, dates_};
  RawUsage raw_usage_{run_};
  ComputerFiles computer_files_{run_};
  RawLimits raw_limits_{run_};
  RawPolls raw_polls_{waker_, descriptors_};
  RawDraws raw_draws_{run_};
  RawTransfers raw_transfers_{run_,        waker_,         activations_, descriptors_,
                              raw_timers_, local_sockets_, raw_draws_,   outside_};
  RawChildWaits raw_child_waits_{run_, waker_, unknown_children_};
  RawIpc raw_ipc_{run_, waker_, activations_, objects_, descriptors_};
  RawCalls raw_calls_{
      run_,
      waker_,
      {raw_times_, raw_usage_, raw_timers_, raw_polls_, raw_transfers_, raw_child_waits_,
       raw_scheduling_, raw_ipc_, words_, local_sockets_, computer_files_, raw_limits_},
      [this](Task& task) { return notifications_.Yield(task); },
      [this](Task& task, const TrappedCall& call) { trapped_.Exit(task, call); }};
  TrappedWaits trapped_waits_{words_, raw_child_waits_, activations_};
  TrappedCalls trapped_{run_,    waker_,     futexes_,       raw_calls_, guard_,
                        deaths_, *executor_, local_sockets_, spawns_};
  KeptCalls kept_calls_{waker_, descriptors_};
  FollowUps follow_ups_{run_, objects_, shared_events_, signals_, signal_wakes_, spawns_};

  // What they notify.
  Notifications notifications_{
      run_,
      waker_,
      {expulsion_, descriptors_, unknown_children_, timers_, spawns_, scheduling_, signals_,
       objects_, dds_, local_sockets_, outside_, spins_, dates_}};

  // What users are told.
  DebuggerHold debugger_{run_};
  StandstillWatch standstill_{run_, unmanaged_, unknown_children_};
  RunReporter reporter_{run_,
                        {clock_, world_, usage_, launches_, dds_.records(), pacing_, activations_,
                         answers_, datagrams_, words_.table()}};
  StateLink state_link_;
  StateDump state_dump_{{run_, clock_, host_cpu_, world_, network_, launches_, ahead_,
                         words_.table(), objects_.queues(), dds_.hub(), unknown_children_, pacing_,
                         state_link_}};

  // The host's CPU on which all of the run takes turns: one of the two.
  CpuClaim claim_;
  std::optional<LentCpu> lent_;  // while the run is paused
  bool asks_for_processor_ = false;
  HostTime standing_since_;  // while it stands
  std::optional<CpuShare> share_;
  std::vector<int> helpers_cpus_;      // others, for the world
  std::vector<Task*> ready_awaiters_;  // whose descriptors have become ready just now
  shm::RunMemory* memory_ = nullptr;
  UniqueFd memfd_, signal_fd_;
  // Of the running thread, where there are only gates: it says that a call begins, and may go on.
  bool says_call_ = false, opens_gate_ = false;
  std::vector<Late> put_off_;
  std::vector<TrappedCall> unborn_calls_;  // of threads that are to be known soon

  bool awaits_outside_ = false, shows_outside_ = false;
  bool reached_end_ = false;
  std::optional<VirtualTime> idle_at_;  // where nobody acts by itself,
  HostTime idle_since_;                 // and since when
  bool has_spinners_ = false;           // threads that stepped aside

  int shows_ = 0;

  std::uint64_t next_look_tsc_ = 0;
  HostTime next_flush_;
};

}  // namespace tcs
