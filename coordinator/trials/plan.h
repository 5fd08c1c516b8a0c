// The plan of `tcsim trials`: one scenario, many seeds, perhaps several values of one key, or of
// several keys, which make a grid. Pure.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace tcs {

// The options that all trials have in common, as `tcsim run` takes them. Empty: not given.
struct TrialOptions {
  std::string sync = "consistent", accounting = "measured";
  std::string duration, drift;
  std::vector<std::string> set;  // KEY=VALUE
};

// A key of the scenario, and its values, each of which gets trials of its own.
struct Vary {
  std::string key;
  std::vector<std::string> values;
};

struct TrialsPlan {
  std::string scenario;  // the file, as a path that holds in any folder
  std::string name;      // a label for people
  std::uint64_t first_seed = 1;
  int trials = 0;  // of each group; a group's trials have consecutive seeds
  TrialOptions options;
  std::vector<Vary> vary;  // each combination of the keys' values makes a group
};

struct Trial {
  std::uint64_t seed = 0;
  std::size_t group = 0;  // 0 without --vary
  std::string folder;     // beneath the result folder: "seed-0001", "0.5/seed-0001", "0.5,1ms/…"
};

// The values of a group, one for each key; the last key's change first from group to group.
std::vector<std::string> ValuesOf(const TrialsPlan& plan, std::size_t group);

// How many groups there are; 1 without --vary.
std::size_t GroupCount(const TrialsPlan& plan);

// The folder of a group's trials beneath the result folder: the group's values, with commas between
// them, which no value has; empty without --vary.
std::string GroupFolder(const std::vector<std::string>& values);

// All trials, the groups in turn for each seed: a call that stops half-way has as many trials of
// each group.
std::vector<Trial> TrialsOf(const TrialsPlan& plan);

// A label for each group: "drift=1ms", "drift=1ms speed=0.5", or the plan's name.
std::vector<std::string> GroupLabels(const TrialsPlan& plan);

// The arguments of `tcsim run` for this trial, besides where its files go.
std::vector<std::string> RunArgumentsOf(const TrialsPlan& plan, const Trial& trial);

// Reads "KEY=V1,V2". Returns a sentence if the text is not of that form, or if the names of the
// values' folders would be the same.
[[nodiscard]] std::string ParseVary(const std::string& text, Vary* vary);

// A sentence where an option, or another --vary, would outdo the values; empty if none does.
[[nodiscard]] std::string WhatHidesValues(const TrialsPlan& plan);

// The KEY=VALUE texts that hold for a group: those of the options, and the group's values.
std::vector<std::string> SettingsOf(const TrialsPlan& plan, std::size_t group);

}  // namespace tcs
