// --set KEY=VALUE: a scenario's tree with one of its keys added, replaced or removed.
//
// KEY is the way to the key from the top, as the loader's own sentences write it: keys joined by
// dots, elements of lists by number ("command.5" or "command[5]"). Names may have dots themselves;
// of the names that fit the longest is meant. VALUE is YAML; null removes the key.
//
// Internal to the loader: mistakes are thrown as ScenarioMistake.
#pragma once

#include <yaml-cpp/yaml.h>

#include <string>
#include <utility>
#include <vector>

namespace tcs {

// A key with its value, as a text "KEY=VALUE", and where it was given: "--set KEY=VALUE", or
// "FILE:LINE" of an overlay.
struct Setting {
  std::string text;
  std::string origin;
};

// The settings that --set gives.
std::vector<Setting> SettingsOfOptions(const std::vector<std::string>& options);

class SetOptions {
 public:
  // The tree `root` with the `settings` applied in their order. Changes nothing of `root`, whose
  // nodes the new tree shares.
  YAML::Node Apply(const YAML::Node& root, const std::vector<Setting>& settings);

  // The origin of the setting that `node` of the new tree comes from; null if `node` comes from the
  // scenario file.
  const std::string* OriginOf(const YAML::Node& node) const;

 private:
  friend class SetOption;
  std::vector<std::pair<YAML::Node, std::string>> origins_;
};

}  // namespace tcs
