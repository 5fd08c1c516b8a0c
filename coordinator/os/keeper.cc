#include "coordinator/os/keeper.h"

#include <errno.h>
#include <signal.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <utility>

#include "coordinator/os/descendants.h"
#include "coordinator/os/end_signals.h"
#include "coordinator/os/files.h"
#include "coordinator/os/say.h"
#include "coordinator/os/signal_bits.h"
#include "coordinator/os/strays.h"
#include "coordinator/os/whereabouts.h"
#include "coordinator/port/clocks.h"
#include "coordinator/port/levels.h"
#include "coordinator/port/proc_files.h"
#include "shm/time_values.h"

namespace tcs {

namespace {

// The time between looks at whether a stop is one of the whole job.
constexpr std::int64_t kStopTurnNs = 100'000'000;

// True if a signal has stopped the process, or is about to.
bool IsStopped(pid_t pid) {
  const SignalSets sets = ReadSignalSets(pid);
  const std::uint64_t pending = (sets.own_pending | sets.shared_pending) & ~sets.ignored;
  return ThreadState(pid) == 'T' || (pending & kStopSignals & ~sets.blocked) != 0;
}

class Keeper {
 public:
  Keeper(pid_t guardian, pid_t coordinator, const GuardLimits& limits, GuardedState* state)
      : guardian_(guardian), coordinator_(coordinator), limits_(limits), state_(*state) {
    sigaddset(&awaited_, SIGCHLD);
    LookLater();
  }

  // Watches until the coordinator has ended. Returns how it has ended, as of waitpid.
  int Watch() {
    for (;;) {
      const int signal = NextSignal();
      if (signal != SIGCHLD && signal > 0) PassOn(signal);
      int status = 0;
      while (waitpid(coordinator_, &status, WNOHANG | WUNTRACED) == coordinator_) {
        if (!WIFSTOPPED(status)) return status;
        is_stopped_ = true;
      }
      const std::int64_t now_ns = HostClockNs(CLOCK_MONOTONIC);
      if (is_stopped_) LookAtStop();
      if (now_ns >= stop_by_ns_) {
        Kill("the run did not stop in time and is killed");
      } else if (now_ns >= look_at_ns_) {
        Look();
      }
    }
  }

  // Says what a user has to know of an end by a signal; not twice.
  void SayHowItEnded(int status) const {
    if (!WIFSIGNALED(status) || has_killed_) return;
    const int signal = WTERMSIG(status);
    for (const int asked_for : {SIGHUP, SIGINT, SIGQUIT, SIGTERM, SIGPIPE}) {
      if (signal == asked_for) return;
    }
    const std::string by = "signal " + std::to_string(signal) + " (" + strsignal(signal) + ")";
    if (signal == SIGKILL) {
      return Say("the coordinator was killed by " + by +
                 ", and the run with it; what it has written until then can be read");
    }
    Say("the coordinator died of " + by +
        ", and the run with it; this is a fault of tcsim, please report it");
  }

 private:
  // The next signal that has come; 0: no signal comes until something is to be looked at.
  int NextSignal() const {
    const std::int64_t until_ns = std::min({look_at_ns_, stop_by_ns_, stop_turn_ns_});
    const std::int64_t left_ns = std::max<std::int64_t>(0, until_ns - HostClockNs(CLOCK_MONOTONIC));
    const timespec left = shm::ToTimespec(left_ns);
    return std::max(0, sigtimedwait(&awaited_, nullptr, &left));
  }

  void PassOn(int signal) {
    if (getppid() != guardian_ && !std::exchange(is_orphan_, true)) {
      Say("tcsim (process " + std::to_string(guardian_) + ") was killed; its run ends");
    }
    kill(coordinator_, signal);
    kill(coordinator_, SIGCONT);
    stop_by_ns_ =
        std::min(stop_by_ns_, HostClockNs(CLOCK_MONOTONIC) +
                                  std::int64_t{limits_.stop_within_s} * shm::kNsPerSecond);
  }

  // A stop of the job, by ^Z for one, is the guardian's, too: then the coordinator goes on with the
  // guardian. Any other stop would leave the coordinator's clients at real-time priority with
  // nobody above them.
  void LookAtStop() {
    const std::int64_t now_ns = HostClockNs(CLOCK_MONOTONIC);
    if (stop_turn_ns_ == kNever) {
      stop_turn_ns_ = now_ns + kStopTurnNs;
      return;
    }
    if (now_ns < stop_turn_ns_) return;
    stop_turn_ns_ = now_ns + kStopTurnNs;
    if (!IsStopped(coordinator_)) {
      is_stopped_ = was_the_jobs_ = false;
      stop_turn_ns_ = kNever;
      return;
    }
    if (IsStopped(guardian_)) {
      was_the_jobs_ = true;
      return;
    }
    if (!was_the_jobs_ && !std::exchange(has_said_stop_, true)) {
      Say("the coordinator (process " + std::to_string(coordinator_) +
          ") was stopped by a signal, and is made to go on; to stop a run, stop tcsim (process " +
          std::to_string(guardian_) + ")");
    }
    kill(coordinator_, SIGCONT);
  }

  void LookLater() {
    look_at_ns_ =
        HostClockNs(CLOCK_MONOTONIC) + std::int64_t{limits_.look_every_s} * shm::kNsPerSecond;
  }

  void Look() {
    LookLater();
    const std::uint64_t beats = state_.beats.load();
    const std::int64_t computed_ns = std::max<std::int64_t>(0, ProcessCpuClockNs(coordinator_));
    const bool stands = std::exchange(beats_seen_, beats) == beats;
    const bool is_busy = computed_ns - std::exchange(computed_ns_, computed_ns) >
                         std::int64_t{limits_.look_every_s} * (shm::kNsPerSecond / 5 * 4);
    const ComputedTimes times = ComputedBy(coordinator_), before = std::exchange(times_, times);
    const bool is_held = ThreadState(coordinator_) == 't';
    const bool was_held = std::exchange(was_held_, is_held);
    if (stands && is_busy) {
      KillWhereItIs((times.system_ns - before.system_ns) / shm::kNsPerSecond);
    } else if (stands && is_held && was_held) {
      Kill("process " + std::to_string(TracerOf(coordinator_)) +
           " traces the coordinator and has stopped it; the run is killed");
    }
  }

  void Kill(const std::string& sentence, int signal = SIGKILL) {
    stop_by_ns_ = look_at_ns_ = kNever;
    if (!std::exchange(has_killed_, true)) Say(sentence);
    // In the kernel the coordinator may spin for something that its priority prevents.
    LeaveRealTime(coordinator_);
    kill(coordinator_, signal);
  }

  // The coordinator says where it computes, if it can (whereabouts.h): in the kernel it may be
  // unable to.
  void KillWhereItIs(std::int64_t in_kernel_s) {
    Kill("the coordinator computes without making progress (" + std::to_string(in_kernel_s) +
             " of the last " + std::to_string(limits_.look_every_s) +
             " s in the kernel), and is killed; this is a fault of tcsim, please report it",
         SIGABRT);
    stop_by_ns_ =
        HostClockNs(CLOCK_MONOTONIC) + std::int64_t{limits_.say_within_s} * shm::kNsPerSecond;
  }

  static constexpr std::int64_t kNever = INT64_MAX;

  const pid_t guardian_, coordinator_;
  const GuardLimits limits_;
  GuardedState& state_;
  sigset_t awaited_ = EndSignals();
  std::int64_t look_at_ns_ = kNever, stop_by_ns_ = kNever, stop_turn_ns_ = kNever;
  std::uint64_t beats_seen_ = 0;
  std::int64_t computed_ns_ = 0;
  ComputedTimes times_;
  bool is_orphan_ = false, has_killed_ = false;
  bool is_stopped_ = false, was_the_jobs_ = false, has_said_stop_ = false;
  bool was_held_ = false;
};

}  // namespace

void EndWhatIsLeft(int status, GuardedState* state) {
  const int cpu = state->clients_cpu.load();
  if (WIFSIGNALED(status) && cpu >= 0) LowerStraysOn(cpu, state->pid_max);
  KillDescendants();
  for (Removal& removal : state->removals) {
    if (removal.is_set.exchange(false)) RemoveAll(removal.path);
  }
  const int which = state->note.exchange(-1);
  if (which < 0) return;
  const Note& note = state->notes[which];
  // A disk that is full could not be helped here.
  static_cast<void>(WriteWhole(note.path, std::string(note.text, note.size), Withstands::kCrash));
}

void DieOf(int signal_number) {
  const rlimit no_core{0, 0};
  setrlimit(RLIMIT_CORE, &no_core);
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  signal(signal_number, SIG_DFL);
  raise(signal_number);
  _exit(128 + signal_number);
}

void Keep(pid_t guardian, const GuardLimits& limits, GuardedState* state,
          const std::function<int()>& coordinate) {
  const pid_t group = getpgrp(), keeper = getpid();
  setpgid(0, 0);
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  prctl(PR_SET_CHILD_SUBREAPER, 1);
  if (getppid() != guardian) _exit(127);
  const pid_t coordinator = fork();
  if (coordinator == 0) {
    setpgid(0, group);
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != keeper) _exit(127);
    TellWhereItDies();
    // In a script's background SIGINT is ignored, and a SIGINT that comes before it is waited for
    // would be lost.
    signal(SIGINT, SIG_DFL);
    const int status = coordinate();
    fflush(nullptr);  // from the terminal's foreground
    // When the last process of a group goes whose parent is in another group, the kernel sends
    // SIGHUP to the whole group if a process is stopped there: to the script that called tcsim,
    // where no shell controls jobs.
    setpgid(0, keeper);
    exit(status);
  }
  if (coordinator < 0) {
    Say(std::string("no process can be made: ") + strerror(errno) +
        "; end some, or raise `ulimit -u`");
    _exit(2);
  }
  // The keeper speaks from the background of a terminal that may not want that.
  for (const int ignored : {SIGQUIT, SIGPIPE, SIGTTOU}) signal(ignored, SIG_IGN);
  prctl(PR_SET_DUMPABLE, 0);
  Keeper watch(guardian, coordinator, limits, state);
  const int status = watch.Watch();
  state->has_ended.store(true);
  EndWhatIsLeft(status, state);
  watch.SayHowItEnded(status);
  if (WIFSIGNALED(status)) DieOf(WTERMSIG(status));
  _exit(WEXITSTATUS(status));
}

}  // namespace tcs
