// One of the two things that are compared: a run, or a set of trials, perhaps over a grid of
// values.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "coordinator/measures/measure.h"

namespace tcs::compare {

// A figure in all trials of a cell, by their seeds. Of a set in which it is missing from some
// trials there are fewer.
struct Sample {
  Measure kind;  // its value is of no use here
  std::vector<double> values;
  std::vector<std::uint64_t> seeds;
};

// Trials that differ in nothing but their seeds: those of one combination of values.
struct Cell {
  std::map<std::string, Sample> samples;  // by the figure's name
  std::size_t trials = 0;                 // that are done
  std::size_t failed = 0;                 // a client of them failed
  // Of a single run: figures of consecutive parts of it, which say how much it varied in itself.
  std::map<std::string, std::vector<double>> parts;
};

struct Side {
  std::string folder;    // as it was given
  std::string scenario;  // its name
  std::string accounting, sync;
  std::int64_t duration_ns = 0;       // as its first run says
  bool is_run = false;                // one run, no trials
  std::vector<std::string> keys;      // that were varied, sorted
  std::map<std::string, Cell> cells;  // "drift=1ms speed=0.5"; "" where nothing was varied
  std::vector<std::string> warnings;  // one sentence each

  [[nodiscard]] bool IsFixed() const { return accounting == "fixed"; }
};

}  // namespace tcs::compare
