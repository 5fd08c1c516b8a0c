// The parts of a run, and how they know of each other. No logic: the parts themselves decide what
// happens. The parts are made in this order, and go in the reverse one.
#pragma once

#include <memory>
#include <string>

#include "coordinator/calls/after_calls.h"
#include "coordinator/calls/child_stops.h"
#include "coordinator/calls/datagram_log.h"
#include "coordinator/calls/datagram_queues.h"
#include "coordinator/calls/dds_gateway.h"
#include "coordinator/calls/descriptor_waits.h"
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
#include "coordinator/calls/scheduling_calls.h"
#include "coordinator/calls/shared_events.h"
#include "coordinator/calls/signal_calls.h"
#include "coordinator/calls/signal_wakes.h"
#include "coordinator/calls/spawns.h"
#include "coordinator/calls/syscall_child_waits.h"
#include "coordinator/calls/syscall_draws.h"
#include "coordinator/calls/syscall_polls.h"
#include "coordinator/calls/syscall_scheduling.h"
#include "coordinator/calls/syscall_timers.h"
#include "coordinator/calls/syscall_times.h"
#include "coordinator/calls/syscall_transfers.h"
#include "coordinator/calls/syscalls.h"
#include "coordinator/calls/timer_calls.h"
#include "coordinator/calls/timer_signals.h"
#include "coordinator/calls/trapped_calls.h"
#include "coordinator/calls/trapped_waits.h"
#include "coordinator/dump/state_link.h"
#include "coordinator/engine/block_detection.h"
#include "coordinator/engine/clock_pages.h"
#include "coordinator/engine/computing_ahead.h"
#include "coordinator/engine/debugger_hold.h"
#include "coordinator/engine/dispatcher.h"
#include "coordinator/engine/early_turns.h"
#include "coordinator/engine/end_requests.h"
#include "coordinator/engine/event_pump.h"
#include "coordinator/engine/gate_keeper.h"
#include "coordinator/engine/home_processor.h"
#include "coordinator/engine/horizons.h"
#include "coordinator/engine/idle_time.h"
#include "coordinator/engine/kernel_events.h"
#include "coordinator/engine/lookout.h"
#include "coordinator/engine/loop.h"
#include "coordinator/engine/network_leaf.h"
#include "coordinator/engine/notification_receiver.h"
#include "coordinator/engine/outside_leaf.h"
#include "coordinator/engine/pace_keeper.h"
#include "coordinator/engine/pacing.h"
#include "coordinator/engine/run_end.h"
#include "coordinator/engine/run_reporter.h"
#include "coordinator/engine/settler.h"
#include "coordinator/engine/setup.h"
#include "coordinator/engine/spinners.h"
#include "coordinator/engine/standstill_watch.h"
#include "coordinator/engine/state_dump.h"
#include "coordinator/engine/trap_receiver.h"
#include "coordinator/engine/turns_beside.h"
#include "coordinator/engine/unseen_threads.h"
#include "coordinator/engine/world_leaf.h"
#include "coordinator/host/executor.h"
#include "coordinator/host/host_cpu.h"
#include "coordinator/network/robot_network.h"
#include "coordinator/os/real_time_right.h"
#include "coordinator/port/unique_fd.h"
#include "coordinator/processes/bare_programs.h"
#include "coordinator/processes/grace.h"
#include "coordinator/processes/kernel_blocked_threads.h"
#include "coordinator/processes/launches.h"
#include "coordinator/processes/protocol_violations.h"
#include "coordinator/processes/registration.h"
#include "coordinator/processes/registration_sockets.h"
#include "coordinator/processes/ros_daemon.h"
#include "coordinator/processes/run_records.h"
#include "coordinator/processes/slot_check.h"
#include "coordinator/processes/thread_creation.h"
#include "coordinator/processes/thread_exit.h"
#include "coordinator/processes/trap_listeners.h"
#include "coordinator/processes/undispatched_threads.h"
#include "coordinator/processes/unregistered_children.h"
#include "coordinator/processes/unregistered_threads.h"
#include "coordinator/processes/usage_book.h"
#include "coordinator/tasks/activations.h"
#include "coordinator/tasks/coordinator.h"
#include "coordinator/tasks/reactor.h"
#include "coordinator/tasks/run_clock.h"
#include "coordinator/tasks/run_state.h"
#include "coordinator/tasks/waker.h"
#include "coordinator/world/world.h"
#include "shm/layout.h"

namespace tcs {

// The permissions of the host, which decide how a run keeps its threads apart.
struct HostPermits {
  RealTimeFacts real_time;
  bool duplicates = true;  // pidfd_getfd
};
HostPermits AskHost();

struct Wiring {
  Wiring(const Scenario& scenario, const RunOptions& options, const HostPermits& permits);
  ~Wiring();
  Wiring(const Wiring&) = delete;
  Wiring& operator=(const Wiring&) = delete;

  const RealTimeFacts real_time;
  RunState run;
  World world{[this](const std::string& text) { run.Warn(text); }};
  RobotNetwork network;
  AnswerFeed answers;
  Activations activations;
  RunRecords records{run, world, activations};
  Waker waker{run, activations};
  Reactor reactor;
  std::unique_ptr<Executor> executor;
  HostCpu host_cpu;
  KernelBlockedThreads kernel_blocked{run, host_cpu};
  UndispatchedThreads undispatched{run};
  RunClock clock;
  Pacing pacing{run.options, run.end, run.options.on_notice};
  ComputingAhead ahead{{run, waker, host_cpu, *executor, clock, records}, [this](EventTime when) {
                         return event_pump.Poll(EventPump::kNoWait, when);
                       }};
  TurnsBeside beside{{run, *executor, clock, ahead, records},
                     [this](EventTime when) { return event_pump.Poll(EventPump::kNoWait, when); }};
  // The calls of programs, and their waits.
  PriorityInheritance inheritance{run, waker};
  DdsGateway dds{run, waker, world, inheritance};
  SchedulingCalls scheduling{run, waker, inheritance};
  SyscallScheduling syscall_scheduling{run, scheduling};
  FutexWords words{run, waker};
  LockFutexes locks{run, waker, words, inheritance};
  FutexCalls futexes{run, waker, words, locks,
                     [this](Process* process) { ahead.StayHome(process); }};
  SignalWakes signal_wakes{run, waker, host_cpu.active(), undispatched};
  ChildStops stops{run, waker, signal_wakes, host_cpu.active()};
  SignalCalls signals{
      run, waker, signal_wakes, stops, clock, [this](const Process& process, VirtualTime at) {
        dds.NoteWhetherStopped(process, at);
      }};
  TimerSignals timer_signals{run, waker, signal_wakes};
  TimerCalls timers{run, waker, timer_signals};
  SyscallTimers syscall_timers{run, timers};
  Peers peers{run};
  OutsideWaits outside{run, reactor, peers, [this] { return pacing.RunningTime(); }};
  DescriptorWaits descriptors{reactor, outside};
  SharedEvents shared_events{run, waker, reactor};
  LocalSockets local_sockets{run};
  DatagramLog datagram_log;
  DatagramQueues datagrams{run, answers, datagram_log};
  PostedDatagrams posted{run, world};
  KernelObjectWaits objects{run, waker, [this](EventTime when) {
                              if (world_leaf.GoesOn()) world.ReceiveFromTerminals(when.at);
                            }};
  BarePrograms bare_programs{run};
  RosDaemon ros_daemon{run, peers};
  GuardedCalls guard;

  // The threads and processes that take part: how they come, and how they go.
  SlotCheck slot_check{run.IsFixed(), [this] { return clock.NsAt(host_cpu.stop_tsc()); }};
  UsageBook usage{run.table, slot_check};
  ProtocolViolations violations{run, waker, host_cpu};
  ThreadCreation thread_creation{run, waker, reactor, records};
  ThreadExit thread_exit{run, waker, reactor, host_cpu, usage};
  TrapListeners traps{reactor};
  RegistrationSockets sockets{reactor};
  SpinWaits spins{run};
  DateCalls dates{run, waker};
  Registration registration{
      {run, waker, reactor, host_cpu, sockets, bare_programs, thread_creation, thread_exit},
      {[this](Process& process, EventTime when) {
         TimerCalls::DeletePosix(process);
         dds.Leave(process, when);
       },
       [this](const Process& process) { return dds.AreaOf(process); }}};
  Launches launches{run, waker, thread_creation, sockets, traps, world, network, guard.guarded()};
  UnregisteredThreads unregistered{run};
  UnregisteredChildren unregistered_children{run.table, reactor, unregistered};
  Grace grace{run, reactor, unregistered_children,
              [this](EventTime when) { signals.Sent({}, when); }};

  Spawns spawns{run,
                {*executor, thread_creation, registration, scheduling, bare_programs,
                 unregistered_children, unregistered}};

  // Calls that are made raw.
  SyscallTimes syscall_times{run, waker, dates};
  SyscallUsage syscall_usage{run};
  ComputerFiles computer_files{run};
  SyscallLimits syscall_limits{run};
  SyscallPolls syscall_polls{waker, descriptors};
  SyscallDraws syscall_draws{run};
  SyscallTransfers syscall_transfers{
      run, waker, activations, descriptors, syscall_timers, local_sockets, syscall_draws, outside};
  SyscallChildWaits syscall_child_waits{run, waker, unregistered_children};
  SyscallIpc syscall_ipc{run, waker, activations, objects, descriptors};
  Syscalls syscalls{run,
                    waker,
                    {syscall_times, syscall_usage, syscall_timers, syscall_polls, syscall_transfers,
                     syscall_child_waits, syscall_scheduling, syscall_ipc, words, local_sockets,
                     computer_files, syscall_limits},
                    [this](Task& task) { return notifications.Yield(task); },
                    [this](Task& task, const TrappedCall& call) { trapped.Exit(task, call); }};
  TrappedWaits trapped_waits{words, syscall_child_waits, activations};
  TrappedCalls trapped{run,         waker,     futexes,       syscalls, guard,
                       thread_exit, *executor, local_sockets, spawns};
  KeptCalls kept_calls{waker, descriptors};
  AfterCalls after_calls{run, objects, shared_events, signals, signal_wakes, spawns};

  // The notifications of programs.
  Notifications notifications{
      run,
      waker,
      {violations, descriptors, unregistered_children, timers, spawns, scheduling, signals, objects,
       dds, local_sockets, outside, spins, dates}};

  // The messages to users.
  DebuggerHold debugger{run};
  StandstillWatch standstill{run, unregistered, unregistered_children};
  RunReporter reporter{run,
                       {clock, world, usage, launches, dds.records(), pacing, activations, answers,
                        datagrams, words.table()}};
  StateLink state_link;
  StateDump state_dump{{run, clock, host_cpu, world, network, launches, ahead, words.table(),
                        objects.queues(), dds.hub(), unregistered_children, pacing, state_link}};

  // The run's memory, which all clients can read and of which run.header is the beginning; null
  // before the set-up. And its descriptor.
  shm::RunMemory* memory = nullptr;
  UniqueFd memfd;

  // The engine's own parts, which reach all others: the declaration of each part says what the part
  // does.
  HomeProcessor home_processor;
  EndRequests end_requests;
  GateKeeper gate_keeper{*this};
  EventPump event_pump{*this};
  KernelEvents kernel_events{*this};
  NotificationReceiver notification_receiver{*this};
  TrapReceiver trap_receiver{*this};
  BlockDetection block_detection{*this};
  Horizons horizons{*this};
  ClockPages clock_pages{*this};
  Settler settler{*this};
  Dispatcher dispatcher{*this};
  EarlyTurns early_turns{*this};
  Spinners spinners{*this};
  UnseenThreads unseen_threads{*this};
  WorldLeaf world_leaf{*this};
  NetworkLeaf network_leaf{*this};
  OutsideLeaf outside_leaf{*this};
  IdleTime idle_time{*this};
  Lookout lookout{*this};
  PaceKeeper pace_keeper{*this};
  Loop loop{*this};
  Setup setup{*this};
  RunEnd run_end{*this};
};

}  // namespace tcs
