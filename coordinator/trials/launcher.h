// Where trials run: on this machine (local_launcher.h), or as jobs on a cluster
// (slurm/slurm_launcher.h). A launcher runs the trials that are to be run and tells of them; it
// does not know what is printed.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "coordinator/trials/outcome.h"
#include "coordinator/trials/plan.h"
#include "coordinator/trials/progress.h"

namespace tcs {

struct TrialsWork {
  TrialsPlan plan;
  std::string folder;                     // of the results: where the trials' folders are
  std::vector<Trial> todo;                // to be run; their folders are made anew
  std::vector<TrialOutcome> earlier;      // of trials that are done already, and count
  std::vector<std::int64_t> duration_ns;  // the virtual time of a trial, for each group
};

struct TrialEnd {
  Trial trial;
  std::optional<TrialOutcome> outcome;  // none: the trial failed
  std::string why;                      // why the trial failed
};

// A trial that ended without a result, and not by itself: its machine failed, its job was
// cancelled.
struct TrialLoss {
  Trial trial;
  std::string node, why;
  int times = 1;       // how often the trial was lost so far
  bool again = false;  // the trial is run once more
};

// Calls for those who watch. Each is made between two looks at the trials, and may be empty.
struct LauncherEvents {
  std::function<void(const TrialEnd&, const TrialsProgress&)> on_end;
  // Called a few times a second, if set.
  std::function<void(const TrialsProgress&)> on_progress;
  std::function<void()> on_stopping;  // the first ^C, SIGTERM or SIGHUP
  std::function<void(const TrialLoss&)> on_loss;
  std::function<void(const std::string&)> on_notice;  // one sentence
};

struct LauncherReport {
  bool interrupted = false;
  int stop_signal = 0;  // the signal that did that
  std::string error;    // why nothing more could be run; empty: everything was
  std::vector<TrialEnd> ends;
};

class Launcher {
 public:
  virtual ~Launcher() = default;
  // The calling process must be single-threaded. From here on the launcher takes SIGINT, SIGTERM
  // and SIGHUP: the first signal ends the running trials in order, the second one does not wait for
  // them.
  virtual LauncherReport Run(const TrialsWork& work, const LauncherEvents& events) = 0;
};

}  // namespace tcs
