// Where trials run: on this machine (local_launcher.h), or as jobs on a cluster
// (slurm/slurm_launcher.h). A launcher runs what is to be run and tells of it; it does not know
// what is printed.
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
  std::vector<Trial> todo;                // their folders are made anew
  std::vector<TrialOutcome> earlier;      // are done already, and count
  std::vector<std::int64_t> duration_ns;  // each group's virtual time
};

struct TrialEnd {
  Trial trial;
  std::optional<TrialOutcome> outcome;  // none: it failed
  std::string why;                      // it failed
};

// A trial that ended without a result, and not by itself: its machine failed, its job was
// cancelled.
struct TrialLoss {
  Trial trial;
  std::string node, why;
  int times = 1;       // that this has happened to it
  bool again = false;  // it is run once more
};

// For those who watch; all are called between two looks at the trials. Any may be empty.
struct LauncherEvents {
  std::function<void(const TrialEnd&, const TrialsProgress&)> on_end;
  // A few times a second, if set.
  std::function<void(const TrialsProgress&)> on_progress;
  std::function<void()> on_stopping;  // the first ^C, SIGTERM or SIGHUP
  std::function<void(const TrialLoss&)> on_loss;
  std::function<void(const std::string&)> on_notice;  // one sentence
};

struct LauncherReport {
  bool interrupted = false;
  int stop_signal = 0;  // which did that
  std::string error;    // why nothing more could be run; empty: everything was
  std::vector<TrialEnd> ends;
};

class Launcher {
 public:
  virtual ~Launcher() = default;
  // The calling process must be single-threaded; SIGINT, SIGTERM and SIGHUP are its own from here
  // on: the first one ends the running trials in order, the second one does not wait for them.
  virtual LauncherReport Run(const TrialsWork& work, const LauncherEvents& events) = 0;
};

}  // namespace tcs
