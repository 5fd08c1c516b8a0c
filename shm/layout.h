// The shared memory: the contract between the coordinator and the shim inside each client.
//
//   of the run:            +-----------+----------+--------------+--------------+
//   the coordinator's      | RunHeader | IpcTimes | OwnReceivers | LocalSockets | OutsideFiles |
//                          +-----------+----------+--------------+--------------+--------------+
//                          (own_receivers.h, local_sockets.h, outside_files.h)
//   of each process:       +---------------+---------------+-----
//   its and the            | ThreadSlot[0] | ThreadSlot[1] | ...
//   coordinator's          +---------------+---------------+-----
//
// Sealed memfds that never have a name. The coordinator makes them, the shim maps them when its
// process attaches (attach_protocol.h). All processes can read the run's memory, and only the
// coordinator can write it. No other process sees the memory of a process. A thread slot belongs to
// one kernel thread from its attach to its end.
//
// Writers. Each group of fields names its writer. The coordinator writes a slot's clock only while
// the slot's thread is stopped, and bumps the dispatch number in the two adjustment words each
// time; the thread moves those words by compare-and-swap and so notices that it was stopped in
// between (clock_page.h). The coordinator trusts nothing that it reads here: it copies, then
// checks, and keeps its own value of every clock.
//
// Any change to a size, an offset or a meaning bumps kVersion. All times are virtual nanoseconds
// since the run's start unless the name says otherwise.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>

#include "shm/command_ring.h"
#include "shm/datagram_notes.h"
#include "shm/ipc_times.h"
#include "shm/receipts.h"
#include "shm/spin_streak.h"
#include "shm/work_counts.h"

namespace tcs::shm {

inline constexpr std::uint64_t kMagic = 0x314d4853'53435401;  // never 0
inline constexpr std::uint32_t kVersion = 32;
inline constexpr std::uint32_t kSlotCount = 4096;  // of a process
inline constexpr std::int64_t kNeverNs = INT64_MAX;
// The furthest horizon a dispatch may carry, so that an adjustment fits its 48 bits: about 19
// hours.
inline constexpr std::int64_t kMaxDispatchNs = std::int64_t{1} << 46;

// The kinds of notification from the shim to the coordinator. The thread is stopped from its
// notification to its next dispatch.
enum class NotificationKind : std::uint32_t {
  kNone = 0,
  kHorizon = 1,    // the thread's clock has reached its horizon
  kRead = 2,       // go on once nothing can be produced before time_ns any more
  kWrite = 3,      // go on once no thread can still read before time_ns
  kIdle = 4,       // sleep until deadline_ns; args[0]: 1 if with the signal mask args[1];
                   // 2 if also until a signal of the set args[1] is pending; args[2]: 1 if
                   // deadline_ns is that of a date (kSetDate)
  kWaitFds = 5,    // sleep until one of fds is ready, a signal of the set args[1] is pending, or
                   // deadline_ns; args[0]: 1 if one event of the one descriptor is for one waiter,
                   // the first of several that came, 2 if for the last;
                   // args[2]: 1 to keep the place of the last such wait; args[3]: a KeepFiles;
                   // reply[0]: 1 if files are kept from now on; reply[1]: 1 if other waiters were
                   // passed over, and want to know (kPassOn)
  kPassOn = 32,    // the thread has taken what it was woken for
  kWaitChild = 6,  // sleep until a child process ends (args[0]: its pid, or 0 for any), or also, if
                   // args[1] is not 0, until one stops or goes on; or deadline_ns
  kTimerCreate = 7,   // args[0]: a timerfd that the coordinator makes readable, or -1; args[1] to
                      // args[3]: TimerKind; reply[0]: timer id
  kTimerSet = 8,      // args[0]: timer id, args[1]: first expiry (0 disarms), args[2]: interval,
                      // args[3]: 1 if args[1] is that of a date; reply: as kTimerGet
  kTimerGet = 9,      // args[0]: timer id; reply[0]: next expiry or 0, reply[1]: interval
  kTimerDelete = 10,  // args[0]: timer id
  kSpawned = 11,      // args[0]: pid of a new child that will attach (ThreadSlot::announces)
  kYield = 12,        // let equals run; args[0]: 1 if the thread spins, as with kSpins
  kPriority = 13,     // args[0]: tid, 0 for the own; args[1]: POSIX policy, args[2]: priority, for
                      // the virtual scheduler; reply[0]: 0, or negative for an errno.
  // Policies may have SCHED_RESET_ON_FORK in them, or be kKeepPolicy. args[3]: 1
  // only to ask whether the caller may
  kInterrupted = 14,  // a signal handler wants to run while the thread waits: end the wait; where
                      // the wait is over, and the thread to have a turn, the kind becomes kResumed
  kMadeThread = 15,   // args[0]: pthread_t of a new thread that will attach; args[1..2] as
                      // kPriority's if args[1] >= 0, args[3] as kAffinity's (0: any)
  // A call unknown to the shim has returned; or see kInterrupted. Never sent by the shim itself.
  kResumed = 17,
  kPriorityGet = 18,  // args[0]: tid, 0 for the own; reply[0]: policy, or negative for an errno;
                      // reply[1]: priority
  kAffinity = 19,  // args[0]: tid, 0 for the own; args[1]: the robot's cores that it may use, bit 0
                   // for core 0, 0 to ask only; reply[0]: 0, or negative for an errno; reply[1]: as
                   // then set
  kSignalled = 20,  // the thread has sent signal args[2] (0: unknown) to process args[0] (0: any),
                    // to its thread args[1] (0: to the process)
  kQueueNotifies = 21,  // a message queue will have the kernel send a signal: see queues_notify
  kWaitObject = 22,     // sleep until a kernel object is changed, or deadline_ns; args[0]: a
                     // KernelObjectKind, args[1]: its number, args[2]: 1 to keep the place of the
                     // last such wait; args[3]: 0, or 1 more than a descriptor whose file is kept
                     // as with KeepFiles::kForCall; -1: the file that is kept already
  kWakeObject = 23,    // the object of args[0] and args[1] has been changed
  kTimerOverrun = 24,  // args[0]: timer id; args[1]: 1 if its signal has just been accepted;
                       // reply[0]: overruns of the signal accepted last
  // Of programs that speak DDS (dds_exchange.h).
  kDdsJoin = 25,  // reply[0]: the process's number, or negative for an errno; reply[1]: the drift
                  // bound, ns. The process then asks for its area (attach_protocol.h)
  kDdsSend = 26,  // args[0]: bytes of messages in the outbox
  kDdsWait = 27,  // the thread is the deliverer: sleep until something is due; reply[0]: bytes of
                  // messages in the inbox
  kDdsSync = 28,  // go on once the deliverer has handed over what is due, or waits for others
  kDdsRoom = 29,  // go on once less waits for the process args[0], or at the deadline
  kDdsSockets =
      30,  // a program's DDS uses sockets, though it was to use dds_exchange.h; args[0]: WhySockets
  kKernelWait = 31,  // in its next system call the kernel may hold the thread; see kernel_waiters
  kCall = 33,  // a call begins: what the thread did before is done (RunHeader::is_unprivileged)
  kPreempted = 34,  // the thread computes, and has got kPreemptionSignal
  // Of sockets that are known to be local to one robot (local_sockets.h).
  kBinds = 35,  // the thread is about to bind a datagram socket to an abstract name; args[0]: the
                // socket's cookie, args[1]: the name's hash
  kSignals =
      37,  // the thread is about to send a signal to process args[0], or a group: as kReaches
  kReaches = 36,  // the thread is about to reach a local socket of robot args[0], from another
                  // robot or with a descriptor that leaves its own: go on as with kWrite, and once
                  // that robot has looked for the last time without waiting for others
  kCounterReads = 39,  // code of the program reads the processor's cycle counter and could not be
                       // led to the virtual one; args[0]: in how many places, args[1]: the
                       // first, args[2]: WhereReads
  kChildUsage = 38,    // args[0]: pid of a child that has ended; reply[0]: what the child and its
                       // own children were charged, ns; -1: not known
  kSpins = 41,         // the thread looks at memory again and again (ThreadSlot::spin)
  kSetDate = 42,       // CLOCK_REALTIME shows args[0] now; reply[0]: 0, or negative for an errno
  kOutside = 40,  // of a file by which the program may meet what is outside of the run; args: an
                  // OutsideEvent, and what it says (outside_files.h)
};

// The signal by which the coordinator stops a thread that computes, where only gates keep threads
// apart, and under set costs a thread that is not dispatched (RunHeader::preempts). The signal is
// one of the two that the C library keeps for itself: programs can neither catch nor block it, and
// it is in none of their sets. The library uses it for set*id() in programs of several threads, and
// recognises its own signals by their sender. The signal carries the number of the dispatch that is
// to end; or kAsksWhere: then the thread only looks whether it spins (SpinStreak::in_loop).
inline constexpr int kPreemptionSignal = 33;
inline constexpr std::uint64_t kAsksWhere = std::uint64_t{1} << 32;

// Of ClockPage::counts_work, where only gates keep threads apart: the dispatch begins in a call
// that the kernel carries out, so that the thread says once it is done (kCall).
inline constexpr std::uint64_t kBeginsInCall = 2;
// Of ClockPage::counts_work, too: the thread computes ahead of its turns, and each of its calls
// begins at its gate.
inline constexpr std::uint64_t kIsAhead = 4;

inline constexpr std::int64_t kKeepPolicy = -1;

// Linux keeps the file of a call for as long as the call lasts, whatever the file's number comes to
// mean meanwhile. So does the coordinator with the files that a thread waits for. Where their
// numbers mean other files after the wait, or none, it keeps them beyond the wait: until the
// thread's next wait that does not want them, or kLeaveFiles.
enum class KeepFiles : std::int64_t {
  kNot = 0,
  kForCall = 1,  // the file of the one descriptor in `fds`; with no events it is not waited for
  kForPoll = 2,  // the files of all of them: found by their numbers, waited for as files
  kAgain = 3,    // the files that were kept are waited for
  kForSet = 4,   // as kForCall, of an epoll set
};

// Operations of futex(2), for the shim to say something without a notification: the calls are
// always handed over, and answered at once. The kernel knows neither operation.
inline constexpr std::uint32_t kTakeFile = 0x7c570001;    // a descriptor of the file that was kept
inline constexpr std::uint32_t kLeaveFiles = 0x7c570002;  // the files that were kept are given up

enum class WhySockets : std::uint32_t {
  kOtherLibrary = 1,     // the program's libddsc is none that libtcs_dds.so is written for
  kLooksUpItself = 2,    // the program looks libddsc's functions up by itself, past the shim
  kNoLibraryOfOurs = 3,  // libtcs_dds.so cannot be loaded
  kNoRoom = 4            // the process could not join
};

// Kernel objects that cannot be polled. Two kinds are for waking only. kTerminals: bytes written to
// one end of a terminal reach the other some time later, unless a thread polls. kKernelWaits: the
// kernel may have let threads go on that it held.
enum class KernelObjectKind : std::uint32_t {
  kSemaphores = 1,
  kMessages = 2,
  kBacklogs = 3,
  kTerminals = 4,
  kKernelWaits = 5
};

// Code that reads the cycle counter.
enum class WhereReads : std::int64_t {
  kInFile = 0,      // of the program or a library
  kInMadeCode = 1,  // made at run time
};

// The clock that a timer runs on, and what the timer does besides making a descriptor readable. A
// sigset's bit 0 is signal 1.
enum class TimerClock : std::uint16_t { kTime = 0, kProcessCpu = 1, kThreadCpu = 2 };
struct TimerKind {
  TimerClock clock = TimerClock::kTime;
  std::uint16_t is_posix = 0;   // of timer_create: ends when its process executes another program
  std::int32_t clock_tid = 0;   // of kThreadCpu; of kTime 1 if it was made for CLOCK_REALTIME
  std::int32_t signal = 0;      // to be sent; 0: none
  std::int32_t signal_tid = 0;  // to this thread; 0: to the process
  std::int64_t value = 0;       // in the signal
};
static_assert(sizeof(TimerKind) == 3 * sizeof(std::int64_t));

// Timer ids 0..2 are the process's setitimer timers, by their POSIX numbers (ITIMER_REAL, _VIRTUAL,
// _PROF).
inline constexpr std::int64_t kFirstTimerId = 16;

// Timers of shorter intervals are not processed expiration by expiration: a thread that is about to
// read the descriptor of such a timer asks for its count first (kTimerGet).
inline constexpr std::int64_t kShortIntervalNs = 100'000;

// Why a dispatch ended a wait.
enum class WakeReason : std::uint32_t {
  kGo = 0,        // nothing was waited for, or what was waited for is there
  kDeadline = 1,  // deadline_ns was reached
  kSignal = 2,    // a signal was sent to the process
  kCutOff = 3,    // the notification has not arrived: the connection is another file by now
};

enum class Accounting : std::uint32_t { kMeasured = 1, kFixed = 2 };

// Whether reads and writes wait until they are safe, or happen at once in a world that stands
// still.
enum class Sync : std::uint32_t { kConsistent = 1, kCallback = 2 };

// A thread's clock. See clock_page.h for how it is read and moved.
struct ClockPage {
  // Written by the coordinator at each dispatch.
  std::int64_t base_time_ns;  // the virtual CPU's progress, plus what the thread still owes
  std::int64_t base_cpu_ns;   // charged virtual processor time of the thread
  std::uint64_t base_tsc;
  std::uint64_t
      ns_per_tick_q32;      // virtual ns per TSC tick, times 2^32; 0 where computing costs nothing
  std::int64_t horizon_ns;  // the clock never shows more
  std::int64_t idle_until_ns;  // the thread may move its own clock up to here by sleeping
  std::int64_t read_safe_ns;   // nothing is produced before this any more
  std::int64_t write_safe_ns;  // no thread reads before this any more
  // Written by the coordinator at a dispatch, moved by the thread: 16 bits dispatch number, 48 bits
  // signed ns.
  std::atomic<std::uint64_t> executed_adjust;  // less what was stolen, plus set costs
  std::atomic<std::uint64_t> waited_adjust;    // slept inside the horizon
  // Written by the thread (and by the coordinator while it is stopped).
  std::atomic<std::int64_t> last_shown_ns;  // the clock never shows less
  std::atomic<std::uint64_t> last_check_tsc;
  std::atomic<std::int64_t> stolen_ns;  // removed so far, virtual ns, host-visible statistics only
  // The thread's CPU clock at base_cpu_ns == 0, moved by what is not charged.
  std::int64_t host_cpu_origin_ns;
  // Constant from the thread's first dispatch on.
  std::uint64_t ns_per_host_ns_q32;  // virtual ns per host ns, times 2^32
  std::uint64_t check_after_ticks;   // the CPU clock is asked when this much TSC has passed
  std::int64_t call_cost_ns;         // of each intercepted call; 0 under measured accounting
  std::int64_t other_cpu_ns;         // charged to the process's other threads, living and dead
  std::int64_t children_cpu_ns;      // charged to the process's ended children
  // Written by the thread: the furthest that a read went beyond what was safe.
  std::atomic<std::int64_t> staleness_ns;
  // Written by the coordinator at each dispatch: of each allocation (set_costs.h); 0 under measured
  // accounting.
  std::int64_t allocation_cost_ns;
  std::uint32_t counts_work;  // not 0: the thread keeps its WorkCounts; kBeginsInCall
  // Written by the coordinator, once: 1: other threads have the thread's storage, too
  // (libtcs_preload/shared_storage.cc).
  std::atomic<std::uint32_t> shares_storage;
  // Nothing is produced before this any more in sockets that are local to the robot.
  std::int64_t local_read_safe_ns;
  // Written by the thread, and by the coordinator at each dispatch: the thread's charge when its
  // clock showed last_shown_ns.
  std::atomic<std::int64_t> last_shown_cpu_ns;
};
static_assert(sizeof(ClockPage) == 192);
static_assert(offsetof(ClockPage, staleness_ns) == 152);
static_assert(offsetof(ClockPage, allocation_cost_ns) == 160);
static_assert(offsetof(ClockPage, counts_work) == 168);
static_assert(offsetof(ClockPage, shares_storage) == 172);
static_assert(offsetof(ClockPage, local_read_safe_ns) == 176);
static_assert(offsetof(ClockPage, executed_adjust) == 64);
static_assert(offsetof(ClockPage, last_shown_ns) == 80);

struct WaitFd {
  std::int32_t fd;
  std::uint32_t events;  // EPOLL* bits
};
inline constexpr std::uint32_t kMaxWaitFds = 32;

// Written by the thread before it notifies.
struct Notification {
  NotificationKind kind;
  std::uint32_t fd_count;
  std::int64_t time_ns;      // the thread's clock at the call
  std::int64_t deadline_ns;  // kNeverNs for none
  std::int64_t args[4];
  WaitFd fds[kMaxWaitFds];
};
static_assert(sizeof(Notification) == 312);

// The mark that the shim leaves in the last, unused argument of the system calls that it makes
// itself: those calls go to the kernel. In recvfrom and sendto the mark is in the upper half of the
// flags. All other calls that wait or read time are handed to the coordinator.
inline constexpr std::uint32_t kOwnCallMark = 0x7c57a7e1;

// An operation of a thread on a System V object since the thread was last dispatched (ipc_times.h).
struct IpcNote {
  std::uint64_t object;
  std::int64_t at_ns;  // CLOCK_REALTIME
  IpcEvent event;
  std::uint32_t reserved;
};
static_assert(sizeof(IpcNote) == 24);
inline constexpr std::uint32_t kMostIpcNotes = 8;

// Gate values.
inline constexpr std::uint32_t kGateClosed = 0;  // written by the thread before it notifies
inline constexpr std::uint32_t kGateOpen = 1;    // written by the coordinator: dispatched
inline constexpr std::uint32_t kGateWaiting =
    2;  // written by the thread: it is in futex(2), wake it

// Whether a thread's dispatch is one whose end the coordinator looks for in the slot itself,
// because the thread runs beside the coordinator, on another processor of the host. Such a dispatch
// begins when the thread leaves its gate, and ends when the thread has said so here: `stopped_tsc`
// is when.
//
//            the coordinator                    the thread
//   kByPipe ---------------> kRuns -----------------------------------> kSaid
//      ^ ^                     | the end is waited for no longer          |  | a handler waits
//      | +---------------------+                                          |  v until it is taken
//      +------------------------------------------------------------------+- kSaidAndWaits
enum class Saying : std::uint32_t {
  kByPipe = 0,        // a notification is told by the pipe
  kRuns = 1,          // a notification is told by this word
  kSaid = 2,          // the notification is told, and the coordinator has not taken it yet
  kSaidAndWaits = 3,  // as kSaid; taking it, the coordinator is to wake the thread in futex(2)
};

// In ThreadSlot::signals: the shim makes the system call, of which only the shim knows; or the C
// library makes the call, which the kernel hands over.
inline constexpr std::uint32_t kSendsItself = 1;
inline constexpr std::uint32_t kSendsByLibrary = 1U << 16;

struct alignas(64) ThreadSlot {
  ClockPage clock;
  Notification note;
  // The answer, written by the coordinator before it opens the gate.
  std::atomic<std::uint32_t> gate;
  std::atomic<WakeReason> wake_reason;
  std::int64_t reply[2];
  // Written by the coordinator at the attach.
  std::int32_t pid;
  std::int32_t tid;
  std::uint32_t cores;  // of the robot
  std::uint32_t core;   // the virtual CPU the thread was last dispatched on
  std::uint64_t seed;   // of everything the thread draws from the system in deterministic modes
  std::uint32_t patch_vdso;     // 1: calls of the vDSO are to be led to the shim
  std::uint32_t dds_endpoints;  // 1: Cyclone DDS is to use dds_exchange.h instead of sockets
  // Written by the thread: not 0 while the thread may have sent a signal and not yet said so
  // (kSignalled): how often, each time kSendsItself or kSendsByLibrary.
  std::atomic<std::uint32_t> signals;
  // Written by the thread, emptied by the coordinator when the thread has stopped.
  std::atomic<std::uint32_t> ipc_count;
  IpcNote ipc_notes[kMostIpcNotes];
  Receipts receipts;
  WorkCounts work;  // written by the thread, where it is counted
  // Written by the thread before it notifies, where only gates keep threads apart: the signals that
  // the thread blocks at its gate. The kernel's knowledge of them is true only once the thread
  // waits there.
  std::uint64_t blocked_signals;
  // Written by the thread: how many of its calls the shim has begun and not ended. More than one:
  // calls of handlers within other calls. The count is too high where a handler has left by
  // longjmp.
  std::atomic<std::uint32_t> open_calls;
  // Written by the coordinator at the attach: the robot's number, as in local_sockets.h.
  std::uint32_t robot;
  std::atomic<Saying> saying;
  // Written by the coordinator: not 0 while the thread waits in a call that the kernel has handed
  // over, and once a signal has ended that wait. The thread sets it to 0 when it has a handler run.
  std::atomic<std::uint32_t> waits_in_call;
  std::uint64_t stopped_tsc;
  DatagramNotes datagrams;
  // Written by the thread: not 0 while the thread makes a thread or a process that it will announce
  // (kMadeThread, kSpawned). A thread or process that the kernel makes for it at other times never
  // attaches, or attaches later.
  std::atomic<std::uint32_t> announces;
  // Written by the thread: how many descriptors it has closed or replaced, as far as the shim sees
  // it.
  std::atomic<std::uint32_t> descriptors_changed;
  // Written by the coordinator at the attach: 1: reads of the cycle counter are to be led to the
  // virtual one.
  std::uint32_t leads_counter;
  // Likewise: the most that a thread that spins computes between two pauses, by its clock; 0:
  // pauses are not to be counted (spin_streak.h).
  std::uint32_t spin_gap_ns;
  SpinStreak spin;  // written by the thread
  // Written by the coordinator at each dispatch: the time, by the thread's clock, at which it ends
  // its turn if it spins. kNeverNs where no other thread computes for which it could wait.
  std::int64_t spin_until_ns;
  alignas(64) CommandRing command_ring;
  // Written by the thread when a handler comes before the thread's note is answered, and `note`
  // says so (kInterrupted): the note that was there before. The coordinator may not have read it
  // yet.
  Notification interrupted;
};
static_assert(sizeof(ThreadSlot) == 5696);
static_assert(offsetof(ThreadSlot, datagrams) == 1216);
static_assert(offsetof(ThreadSlot, announces) == 3272);
static_assert(offsetof(ThreadSlot, descriptors_changed) == 3276);
static_assert(offsetof(ThreadSlot, leads_counter) == 3280);
static_assert(offsetof(ThreadSlot, spin) == 3288);
static_assert(offsetof(ThreadSlot, command_ring) == 3328);
static_assert(offsetof(ThreadSlot, note) == 192);
static_assert(offsetof(ThreadSlot, gate) == 504);
static_assert(offsetof(ThreadSlot, pid) == 528);
static_assert(offsetof(ThreadSlot, signals) == 560);
static_assert(offsetof(ThreadSlot, ipc_notes) == 568);
static_assert(offsetof(ThreadSlot, receipts) == 760);
static_assert(offsetof(ThreadSlot, work) == 1168);
static_assert(offsetof(ThreadSlot, robot) == 1196);
static_assert(offsetof(ThreadSlot, saying) == 1200);
static_assert(offsetof(ThreadSlot, waits_in_call) == 1204);
static_assert(offsetof(ThreadSlot, stopped_tsc) == 1208);

// Written by the coordinator before anyone attaches; shutdown and queues_notify change later, once,
// and object_waiters and kernel_waiters.
struct alignas(64) RunHeader {
  std::uint64_t magic;
  std::uint32_t version;
  std::uint32_t header_size;
  std::uint32_t slot_size;
  std::uint32_t slot_count;
  Accounting accounting;
  std::atomic<std::uint32_t> shutdown;  // 1: the run is over; the shim lets every call through
  std::int64_t monotonic_offset_ns;     // CLOCK_MONOTONIC minus virtual time; never 0
  // CLOCK_REALTIME minus virtual time; never 0. Changes when a program sets the date.
  std::atomic<std::int64_t> realtime_offset_ns;
  std::int32_t coordinator_pid;
  Sync sync;
  std::atomic<std::uint32_t> queues_notify;  // 1: a send to a message queue may send a signal
  std::atomic<std::uint32_t>
      object_waiters;  // threads that kWakeObject may concern; if none the call is spared
  std::atomic<std::uint32_t> kernel_waiters;  // as object_waiters, for kKernelWaits
  // 1: only their gates keep threads that are not dispatched from running on: each call that the
  // shim sees begins with kCall.
  std::uint32_t is_unprivileged;
  std::uint32_t preempts;     // 1: the coordinator sends kPreemptionSignal
  std::uint32_t has_brokers;  // 1: each process has a broker (attach_protocol.h)
  // 1: each robot has abstract names of its own (a network namespace).
  std::uint32_t names_by_robot;
  // 1: threads note the datagrams that they send and receive, and sleeps that they need not ask
  // for.
  std::uint32_t notes_activity;
  // 1: threads may have turns before their order; signals to other processes are told of
  // (kSignals).
  std::uint32_t turns_beside;
  // The virtual cycle counter's rate, times 2^32 (clock_page.h).
  std::uint64_t counter_ticks_per_ns_q32;
  // In ticks of the TSC, on this host: a call that does nothing and that no filter looks at; and
  // what pwritev2 and preadv2, which need not wait, take more than write and read. 0: not known.
  std::uint64_t plain_call_ticks, write_form_ticks, read_form_ticks;
};
static_assert(sizeof(RunHeader) == 128);
static_assert(offsetof(RunHeader, monotonic_offset_ns) == 32);
static_assert(offsetof(RunHeader, counter_ticks_per_ns_q32) == 96);
static_assert(offsetof(RunHeader, plain_call_ticks) == 104);

// The memory that only the coordinator writes.
struct RunMemory {
  RunHeader header;
  IpcTimes ipc_times;
};
static_assert(offsetof(RunMemory, ipc_times) == 128);

inline constexpr std::size_t kProcessMemorySize = std::size_t{kSlotCount} * sizeof(ThreadSlot);

static_assert(std::atomic<std::uint64_t>::is_always_lock_free);
static_assert(std::atomic<std::uint32_t>::is_always_lock_free);

}  // namespace tcs::shm
