// One side of a comparison: a run, or a set of trials, perhaps over a grid of values.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "coordinator/measures/measure.h"

namespace tcs::compare {

// The values of a figure in all trials of a cell, by the trials' seeds. There are fewer values
// where the figure is missing from some trials.
struct Sample {
  Measure kind;  // the measure's value is of no use here
  std::vector<double> values;
  std::vector<std::uint64_t> seeds;
};

// The trials of one combination of values, which differ in nothing but their seeds.
struct Cell {
  std::map<std::string, Sample> samples;  // by the figure's name
  std::size_t trials = 0;                 // how many trials are done
  std::size_t failed = 0;                 // how many failed, with a client of theirs
  // For a single run: figures of its consecutive parts, which say how much the run varied within
  // itself.
  std::map<std::string, std::vector<double>> parts;
};

struct Side {
  std::string folder;    // as it was given
  std::string scenario;  // the scenario's name
  std::string accounting, sync;
  std::int64_t duration_ns = 0;       // as the side's first run says
  bool is_run = false;                // the side is one run, no trials
  std::vector<std::string> keys;      // the keys that were varied, sorted
  std::map<std::string, Cell> cells;  // "drift=1ms speed=0.5"; "" where nothing was varied
  std::vector<std::string> warnings;  // one sentence each

  [[nodiscard]] bool IsFixed() const { return accounting == "fixed"; }
};

}  // namespace tcs::compare
