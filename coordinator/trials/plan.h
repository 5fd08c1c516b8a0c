// What `tcsim trials` is to run: one scenario, many seeds, perhaps several values of one key, or of
// several keys: a grid. Pure.
#pragma once

#include <cstddef>
#include <cstdint>
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
  int trials = 0;  // of each group; they have consecutive seeds
  TrialOptions options;
  std::vector<Vary> vary;  // each value of one with each value of the others makes a group
};

struct Trial {
  std::uint64_t seed = 0;
  std::size_t group = 0;  // 0 without --vary
  std::string folder;     // beneath the result folder: "seed-0001", "0.5/seed-0001", "0.5,1ms/…"
};

// The values of a group, one for each key; the last key's change first from group to group.
std::vector<std::string> ValuesOf(const TrialsPlan& plan, std::size_t group);

// 1 without --vary.
std::size_t GroupCount(const TrialsPlan& plan);

// The folder of a group's trials beneath the result folder: its values, with commas between them,
// which no value has; empty without --vary.
std::string GroupFolder(const std::vector<std::string>& values);

// All trials, the groups in turn for each seed: who stops half-way has as much of each.
std::vector<Trial> TrialsOf(const TrialsPlan& plan);

// One for each group: "drift=1ms", "drift=1ms speed=0.5", or the plan's name.
std::vector<std::string> GroupLabels(const TrialsPlan& plan);

// What `tcsim run` is told for this trial, besides where its files go.
std::vector<std::string> RunArgumentsOf(const TrialsPlan& plan, const Trial& trial);

// From "KEY=V1,V2"; the sentence if it is not that, or its values cannot tell their folders apart.
[[nodiscard]] std::string ParseVary(const std::string& text, Vary* vary);

// Where an option, or another --vary, would outdo the values; empty if none does.
[[nodiscard]] std::string WhatHidesValues(const TrialsPlan& plan);

// The KEY=VALUE texts that hold for a group: of the options, and its values.
std::vector<std::string> SettingsOf(const TrialsPlan& plan, std::size_t group);

}  // namespace tcs
