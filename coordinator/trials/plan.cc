#include "coordinator/trials/plan.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <utility>

namespace tcs {

namespace {

// A value as the name of one folder, which is neither hidden nor above: nearly always the value.
std::string FolderOf(const std::string& value) {
  std::string name = value;
  for (char& c : name) {
    if (c == '/' || std::iscntrl(static_cast<unsigned char>(c)) != 0) c = '_';
  }
  if (name[0] == '.') name[0] = '_';
  return name;
}

std::vector<std::string> Split(const std::string& text) {
  std::vector<std::string> parts(1);
  for (const char c : text) {
    if (c == ',') {
      parts.emplace_back();
    } else {
      parts.back() += c;
    }
  }
  return parts;
}

// "drift=1ms", for each key.
std::vector<std::string> ValueSettings(const TrialsPlan& plan, std::size_t group) {
  std::vector<std::string> settings = ValuesOf(plan, group);
  for (std::size_t i = 0; i < settings.size(); ++i) {
    settings[i] = plan.vary[i].key + "=" + settings[i];
  }
  return settings;
}

// Setting `key` sets `other`, too: `key` is the same key, or above it.
bool Covers(const std::string& key, const std::string& other) {
  return other == key || other.starts_with(key + ".");
}

}  // namespace

std::size_t GroupCount(const TrialsPlan& plan) {
  std::size_t groups = 1;
  for (const Vary& vary : plan.vary) groups *= vary.values.size();
  return groups;
}

std::vector<std::string> ValuesOf(const TrialsPlan& plan, std::size_t group) {
  std::vector<std::string> values(plan.vary.size());
  for (std::size_t i = plan.vary.size(); i-- > 0;) {
    const std::vector<std::string>& all = plan.vary[i].values;
    values[i] = all[group % all.size()];
    group /= all.size();
  }
  return values;
}

std::string GroupFolder(const std::vector<std::string>& values) {
  std::string folder;
  for (const std::string& value : values) folder += (folder.empty() ? "" : ",") + FolderOf(value);
  return folder;
}

std::vector<Trial> TrialsOf(const TrialsPlan& plan) {
  std::vector<Trial> trials;
  const std::size_t groups = GroupCount(plan);
  for (int i = 0; i < plan.trials; ++i) {
    const std::uint64_t seed = plan.first_seed + static_cast<std::uint64_t>(i);
    for (std::size_t group = 0; group < groups; ++group) {
      std::string folder = fmt::format("seed-{:04}", seed);
      if (!plan.vary.empty()) folder = GroupFolder(ValuesOf(plan, group)) + "/" + folder;
      trials.push_back({seed, group, folder});
    }
  }
  return trials;
}

std::vector<std::string> GroupLabels(const TrialsPlan& plan) {
  if (plan.vary.empty()) return {plan.name};
  std::vector<std::string> labels;
  for (std::size_t group = 0; group < GroupCount(plan); ++group) {
    labels.push_back(fmt::format("{}", fmt::join(ValueSettings(plan, group), " ")));
  }
  return labels;
}

std::vector<std::string> SettingsOf(const TrialsPlan& plan, std::size_t group) {
  std::vector<std::string> settings = plan.options.set;
  for (std::string& setting : ValueSettings(plan, group)) settings.push_back(std::move(setting));
  return settings;
}

std::vector<std::string> RunArgumentsOf(const TrialsPlan& plan, const Trial& trial) {
  const TrialOptions& options = plan.options;
  std::vector<std::string> words{
      "run", plan.scenario, "--seed", std::to_string(trial.seed), "--host-cpus", "1"};
  const auto add = [&words](const std::string& option, const std::string& value) {
    if (!value.empty()) words.insert(words.end(), {option, value});
  };
  add("--sync", options.sync);
  add("--accounting", options.accounting);
  add("--duration", options.duration);
  add("--drift", options.drift);
  for (const std::string& setting : SettingsOf(plan, trial.group)) add("--set", setting);
  return words;
}

std::string ParseVary(const std::string& text, Vary* vary) {
  const std::size_t equals = text.find('=');
  const bool has_key = equals != std::string::npos && equals > 0;
  if (has_key) *vary = {text.substr(0, equals), Split(text.substr(equals + 1))};
  if (!has_key || std::count(vary->values.begin(), vary->values.end(), "") > 0) {
    return "--vary: '" + text + "' is not KEY=V1,V2; write it like drift=1ms,10ms";
  }
  if (vary->key == "seed") {
    return "--vary: the seeds are set by --trials and --first-seed; vary another key";
  }
  std::vector<std::string> folders;
  for (const std::string& value : vary->values) {
    if (std::count(folders.begin(), folders.end(), FolderOf(value)) > 0) {
      return "--vary: '" + value +
             "' would have the same folder as a value before it; leave it out";
    }
    folders.push_back(FolderOf(value));
  }
  return {};
}

std::string WhatHidesValues(const TrialsPlan& plan) {
  for (std::size_t i = 0; i < plan.vary.size(); ++i) {
    const std::string& key = plan.vary[i].key;
    const auto is_key = [&key](const std::string& setting) {
      return setting.compare(0, key.size() + 1, key + "=") == 0;
    };
    const auto& set = plan.options.set;
    std::string option;
    if (key == "duration" && !plan.options.duration.empty()) option = "--duration";
    if (key == "drift" && !plan.options.drift.empty()) option = "--drift";
    if (std::any_of(set.begin(), set.end(), is_key)) option = "--set";
    for (std::size_t j = 0; j < i; ++j) {
      const std::string& before = plan.vary[j].key;
      if (Covers(key, before) || Covers(before, key)) option = "--vary " + before;
    }
    if (!option.empty()) {
      return fmt::format("--vary {} and {} set the same thing; leave one of them out", key, option);
    }
  }
  return {};
}

}  // namespace tcs
