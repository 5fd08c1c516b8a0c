// What `tcsim trials` is to run: one scenario, many seeds, perhaps several values of one key. Pure.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace tcs {

// What all trials have in common, as `tcsim run` takes it. Empty: not given.
struct TrialOptions {
  std::string sync = "consistent", accounting = "measured";
  std::string duration, drift;
  std::vector<std::string> set;  // KEY=VALUE
};

// One key of the scenario, and the values that each get trials of their own.
struct Vary {
  std::string key;
  std::vector<std::string> values;
};

struct TrialsPlan {
  std::string scenario;  // the file, as a path that holds in any folder
  std::string name;      // a label for people
  std::uint64_t first_seed = 1;
  int trials = 0;  // of each value; they have consecutive seeds
  TrialOptions options;
  std::optional<Vary> vary;
};

struct Trial {
  std::uint64_t seed = 0;
  std::size_t group = 0;  // index of its value; 0 without --vary
  std::string folder;     // beneath the result folder: "seed-0001", "0.5/seed-0001"
};

// All trials, the values in turn for each seed: who stops half-way has as much of each.
std::vector<Trial> TrialsOf(const TrialsPlan& plan);

// One for each value, or the only one: "drift=1ms", or the plan's name.
std::vector<std::string> GroupLabels(const TrialsPlan& plan);

// What `tcsim run` is told for this trial, besides where its files go.
std::vector<std::string> RunArgumentsOf(const TrialsPlan& plan, const Trial& trial);

// From "KEY=V1,V2"; the sentence if it is not that, or its values cannot tell their folders apart.
[[nodiscard]] std::string ParseVary(const std::string& text, Vary* vary);

// Where an option would outdo the values; empty if none does.
[[nodiscard]] std::string WhatHidesValues(const TrialsPlan& plan);

// The KEY=VALUE texts that hold for a group: of the options, and its value.
std::vector<std::string> SettingsOf(const TrialsPlan& plan, std::size_t group);

}  // namespace tcs
