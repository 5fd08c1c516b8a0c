// Runs the trials that are still to be run, several at once.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "coordinator/trials/outcome.h"
#include "coordinator/trials/plan.h"
#include "coordinator/trials/progress.h"

namespace tcs {

// How the runs share the machine.
struct RunnerOptions {
  int at_once = 1;
  bool whole_cores = false;  // see os/cpu_places.h
  bool own_networks = false;
  bool waits_for_cpu = true;  // see os/cpu_claim.h
};

struct TrialEnd {
  Trial trial;
  std::optional<TrialOutcome> outcome;  // none: it failed
  std::string why;                      // it failed
};

// For those who watch; all are called between two looks at the trials.
struct RunnerEvents {
  std::function<void(const TrialEnd&, const TrialsProgress&)> on_end;
  // A few times a second, if set.
  std::function<void(const TrialsProgress&)> on_progress;
  std::function<void()> on_stopping;  // the first ^C, SIGTERM or SIGHUP
};

struct RunnerReport {
  bool interrupted = false;
  int stop_signal = 0;  // which did that
  std::vector<TrialEnd> ends;
};

// `folder` is where the trials' folders are; those of `todo` are made anew. `earlier` are done
// already, and count. `duration_ns` is each group's virtual time. The calling process must be
// single-threaded; SIGINT, SIGTERM and SIGHUP are its own from here on: the first one ends the
// running trials in order, the second one does not wait for them.
RunnerReport RunTrials(const TrialsPlan& plan, const std::string& folder,
                       const std::vector<Trial>& todo, const std::vector<TrialOutcome>& earlier,
                       const std::vector<std::int64_t>& duration_ns, const RunnerOptions& options,
                       const RunnerEvents& events);

}  // namespace tcs
