// The scheduler process: keeps every leaf's progress together, dispatches threads on the one CPU
// they share, charges them, and answers what they notify. One call runs one scenario, on the
// calling thread, which must be the process's only one. All times are nanoseconds: virtual, or real
// where the name says so.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "coordinator/answers/chain_figures.h"
#include "coordinator/answers/client_figures.h"
#include "coordinator/metrics/metric_figures.h"
#include "coordinator/scenario/scenario.h"
#include "coordinator/tasks/usage.h"
#include "shm/layout.h"

namespace tcs {

class ViewLink;

// How a run has kept to its pace; real nanoseconds.
struct PaceReport {
  double pace = 0;             // virtual seconds for each real one; 0: as fast as it can
  bool stands = false;         // until somebody lets it go on
  std::int64_t late_ns = 0;    // where it is now, behind where its pace would have it
  std::int64_t behind_ns = 0;  // for how long it was behind, in all (policy/pacer.h)
  std::int64_t most_ns = 0;    // by how much at most
  std::int64_t stood_ns = 0;   // for how long it was left standing
};

// How a run is going, for people who watch.
struct RunProgress {
  struct Load {
    std::string client;
    std::int64_t charged_ns = 0;
  };
  std::int64_t virtual_ns = 0, real_ns = 0, drift_ns = 0;
  std::int64_t client_ns = 0, dynamics_ns = 0, coordinating_ns = 0;  // real, as in RunReport
  std::vector<Load> clients;
  PaceReport pace;
};

// Into which of rosbag2's storages messages are recorded.
enum class RecordingKind { kNone, kSqlite3, kMcap };

struct RunOptions {
  shm::Accounting accounting = shm::Accounting::kMeasured;
  shm::Sync sync = shm::Sync::kConsistent;
  std::string output_directory;  // empty: clients keep the terminal (tcsim exec)
  bool counts_work = false;      // calls and allocations of each activation, for `tcsim fit`
  RecordingKind record = RecordingKind::kNone;  // of the run's messages, in output_directory
  bool waits_for_cpu = true;                    // where other runs have them all
  double pace = 0;               // virtual seconds for each real one; 0: as fast as it can
  bool starts_standing = false;  // until somebody lets it go on
  ViewLink* view = nullptr;      // where people watch it, or nobody
  int host_cpus = 0;             // at most so many; 0: all that there are
  std::string preload_library;
  std::string debugged;            // a client, for whom on_debuggee gets a debugger; empty: none
  std::string user_preload;        // LD_PRELOAD as the user has it for programs
  std::string allocation_library;  // preloaded besides where allocations are counted
  // The time of CLOCK_MONOTONIC at the start. 0 would look like a clock that was never set.
  std::int64_t uptime_ns = 1'000'000'000'000;
  // The time of CLOCK_REALTIME at the start; if not set the host's date, or a fixed one under fixed
  // accounting.
  std::optional<std::int64_t> date_ns;
  // Called about five times a real second, if set; the time of the call is the coordinator's.
  std::function<void(const RunProgress&)> on_progress;
  // Called with each warning when it arises, if set.
  std::function<void(const std::string&)> on_warning;
  // Of the client `debugged`; both must be set where there is one. The first is called with the
  // client's process when the process is about to begin. The process begins once a tracer has
  // attached to it, or the second says that no tracer will come.
  std::function<void(pid_t)> on_debuggee;
  std::function<bool()> is_debugger_gone;
  // Called with news that people who wait for the run are to know now, if set.
  std::function<void(const std::string&)> on_notice;
  // Called when nothing keeps the run from beginning any more, and what an earlier run has written
  // into the folder is still there; may be null.
  std::function<void()> before_writing;
};

struct ClientReport {
  std::string name;
  ClientFigures figures;            // of runs whose results are kept
  Usage usage;                      // of all processes that it has started, too
  OutsideUsage outside;             // the same
  std::int64_t started_at_ns = -1;  // -1: never
  std::int64_t ended_at_ns = -1;    // before the run did; -1: the client lived to the end
  int wait_status = 0;              // as of waitpid, if it ended
};

struct RunReport {
  std::string error;    // one sentence; empty if the run went to its end
  int exit_status = 0;  // of the first client, as a shell would report it
  bool interrupted = false;
  int stop_signal = 0;  // the signal that did that
  std::int64_t virtual_ns = 0;
  std::int64_t drift_ns = 0;      // largest difference of progress between two leaves
  std::int64_t staleness_ns = 0;  // largest, over all reads
  // The largest time between the sending of something and the instant at which the thread that it
  // woke, and that was to run at once, could run.
  std::int64_t lateness_ns = 0;
  std::int64_t real_ns = 0;
  std::int64_t client_ns = 0, dynamics_ns = 0, coordinating_ns = 0;  // real, of the CPU they share,
  std::int64_t ahead_ns = 0;      // but for what clients have computed on further ones, ahead,
  std::int64_t awaited_ns = 0;    // and for how long the clients were waited for
  std::int64_t turns_beside = 0;  // turns that clients had there before their order
  std::int64_t unaccounted_steals = 0,
               unaccounted_steal_ns = 0;  // how often, and how much, was stolen and no clock told
  std::int64_t switches = 0, samples = 0, commands = 0;
  PaceReport pace;
  std::vector<ClientReport> clients;
  std::vector<ChainFigures> chains;
  MetricsOfRun metrics;              // of runs whose results are kept
  MetricsOfRun kept;                 // of Scenario::kept, by their names
  std::vector<std::string> verdict;  // sentences, worst first
  std::vector<std::string> warnings;
};

RunReport RunScenario(const Scenario& scenario, const RunOptions& options);

}  // namespace tcs
