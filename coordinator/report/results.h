// The contents of result folders (docs/RESULTS.md), as a report needs them. ReadResults
// (read_results.h) fills them in.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "coordinator/measures/measure.h"

namespace tcs::report {

// Times in virtual nanoseconds, as summary.json has them. A count of 0: nothing is known.
struct Quantiles {
  std::int64_t count = 0, p50_ns = 0, p99_ns = 0, max_ns = 0;
};

// A client's deadline, and how often it was missed.
struct ClientDeadline {
  std::int64_t deadline_ns = 0;
  std::string period_of;  // a channel or "its timer"; empty: the scenario says so
  std::int64_t judged = 0, missed = 0;
};

// A chain from a sensor to an actuator.
struct Chain {
  std::string name;
  std::int64_t deadline_ns = 0;  // 0: there is none
  std::int64_t missed = 0;
  Quantiles age;
};

// The times of a client's activations, in one run.
struct ActivationTimes {
  std::vector<double> lateness_s;  // from being made ready to its first processor time
  std::vector<double> response_s;  // from being made ready to being idle
  std::vector<double> computed_s;  // charged in between
};

struct Client {
  std::string robot;
  bool is_periodic = false;
  std::int64_t charged_ns = 0, priced_ns = 0, own_clock_ns = 0, stolen_ns = 0;
  std::int64_t activations = 0, overruns = 0;
  std::optional<ClientDeadline> deadline;
  Quantiles response, data_age;
  std::vector<double> responses_s;  // of all activations that count
  ActivationTimes times;            // where they were asked for
};

// A scenario's expectation of a figure, and its outcome.
struct Expectation {
  std::string subject, figure, what;
  bool holds = false;
};

// The distance between the two bodies.
struct Track {
  std::vector<double> time_s, distance_m;
};

// One run.
struct Run {
  // True if nobody stopped the run, and none of its clients failed.
  bool is_whole = true;
  // Without a summary the figures below are 0, and nothing is known of the clients.
  bool has_summary = true;
  // Answers from runs of earlier versions are missing.
  bool has_answers = false;
  std::vector<std::string> verdict;  // worst first; before all why the run is not whole
  std::vector<std::string> warnings;
  std::vector<Expectation> expectations;
  std::vector<Chain> chains;
  std::string folder, scenario, sync, accounting;
  std::vector<std::string> bodies;
  std::int64_t virtual_ns = 0, real_ns = 0, drift_ns = 0, drift_bound_ns = 0, staleness_ns = 0;
  std::int64_t coordinating_ns = 0, clients_ns = 0, dynamics_ns = 0;
  double overhead = 0;  // share of the real time
  std::map<std::string, Client> clients;
  Measures measures;
  Track track;
  std::string apart[2];  // the bodies that the track is of; empty without
};

// A run of which there is nothing to show, and why.
struct FailedRun {
  std::string name, why;
};

// Runs that differ in nothing but their seeds.
struct System {
  std::string name;
  std::vector<Run> runs;
  std::vector<FailedRun> failed;
};

struct SweepValue {
  std::string text;
  std::optional<double> number;  // durations in seconds
  System system;
};

// A system over several values of one key.
struct Sweep {
  std::string name, key;
  std::vector<SweepValue> values;
};

// A combination of the values of several keys.
struct GridCell {
  std::vector<std::string> values;  // one for each key
  System system;
};

// A system over several keys at once. Only the figures of its runs are read.
struct Grid {
  std::string name;
  std::vector<std::string> keys;
  std::vector<GridCell> cells;
};

struct Results {
  std::string scenario;
  std::string bodies[2];  // whose distance is meant; empty without
  std::vector<System> systems;
  std::vector<Sweep> sweeps;
  std::vector<Grid> grids;
  std::vector<std::string> warnings;  // one sentence each
};

// " in “near”", as a sentence that tells systems apart needs it; nothing where there is only one.
[[nodiscard]] std::string InSystem(const Results& results, const System& system);

// The distances of all runs of a system, one after the other.
[[nodiscard]] std::vector<double> Distances(const System& system);

// The failures, a sentence per reason: "tcs, seed-0003 and seed-0007: it did not end".
[[nodiscard]] std::vector<std::string> Failures(const System& system);

}  // namespace tcs::report
