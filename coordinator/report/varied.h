// Trials over values of keys: sweeps of one key and grids of several, as one thing.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "coordinator/report/results.h"

namespace tcs::report {

struct Varied {
  std::string name;
  std::vector<std::string> keys;
  struct Cell {
    std::vector<std::string> values;  // one for each key
    const System* system = nullptr;   // of the results
  };
  std::vector<Cell> cells;

  // The place of `key` among the keys; none if `key` is not among them.
  [[nodiscard]] std::optional<std::size_t> PlaceOf(const std::string& key) const;
  // The values of a key: numbers in their order, if all are numbers, else as they came.
  [[nodiscard]] std::vector<std::string> ValuesOf(std::size_t key) const;
  // The key of which a plot says most: the processor's speed, else the one with the most values
  // that are numbers.
  [[nodiscard]] std::string TellingKey() const;
};

// All varied trials of the results, with the cells in the order of their values.
[[nodiscard]] std::vector<Varied> AllVaried(const Results& results);

// All keys, each once.
[[nodiscard]] std::vector<std::string> KeysOf(const std::vector<Varied>& all);

// A value as a number, durations in seconds; none if the value is neither.
[[nodiscard]] std::optional<double> ValueAsNumber(const std::string& text);

// The ends of keys that tell them apart, of two parts at least: "cpu.speed".
[[nodiscard]] std::vector<std::string> ShortKeys(const std::vector<std::string>& keys);

}  // namespace tcs::report
