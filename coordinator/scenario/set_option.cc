#include "coordinator/scenario/set_option.h"

#include <algorithm>
#include <charconv>
#include <optional>
#include <string_view>

#include "coordinator/errors/nearest.h"
#include "coordinator/scenario/yaml_reader.h"

namespace tcs {
namespace {

std::string Quote(std::string_view text) { return "'" + std::string(text) + "'"; }

// The user's own names are the keys of these maps: a name that is not there is a slip of the
// fingers, not a thing to be made bit by bit.
bool HoldsNames(const std::string& path) {
  if (path == "bodies" || path == "robots" || path == "channels") return true;
  constexpr std::string_view kRobots = "robots.", kClients = ".clients";
  return path.starts_with(kRobots) && path.ends_with(kClients) &&
         path.size() > kRobots.size() + kClients.size();
}

// The option as a sentence can hold it: on one line, and not much longer than that.
std::string Shown(std::string option) {
  constexpr std::size_t kMost = 100;
  std::replace(option.begin(), option.end(), '\n', ' ');
  if (option.size() > kMost) option = option.substr(0, kMost) + "...";
  return "--set " + option;
}

// True for text that may follow a key in a path: nothing, ".MORE" or "[5]…".
bool EndsKey(std::string_view rest) { return rest.empty() || rest[0] == '.' || rest[0] == '['; }

}  // namespace

// Applies one setting. Whatever this changes it copies, from the top down: nodes of the file may be
// shared, for YAML knows aliases.
class SetOption {
 public:
  SetOption(const Setting& setting, SetOptions* all) : origin_(setting.origin), all_(all) {
    const std::string& option = setting.text;
    const std::size_t equals = option.find('=');
    if (equals == std::string::npos || equals == 0) {
      Fail("this is not KEY=VALUE; write it like --set dynamics.step=1ms");
    }
    path_ = option.substr(0, equals);
    const std::string text = option.substr(equals + 1);
    try {
      const std::vector<YAML::Node> documents = YAML::LoadAll(text);
      if (documents.empty())
        Fail("there is no value; write KEY=VALUE, or KEY=null to remove the key");
      if (documents.size() > 1) Fail("the value is more than one YAML document; give one");
      value_ = documents[0];
    } catch (const YAML::Exception& error) {
      Fail("the value is not valid YAML (" + error.msg +
           "); quote a text that holds : # { } [ or ]");
    }
  }

  YAML::Node ApplyTo(const YAML::Node& root) { return Changed(root, "", path_); }

 private:
  [[noreturn]] void Fail(const std::string& sentence) const {
    throw ScenarioMistake{origin_ + ": " + sentence};
  }

  YAML::Node Ours(const YAML::Node& node) {
    all_->origins_.emplace_back(node, origin_);
    return node;
  }

  // A container to put the children of `old` into.
  YAML::Node CopyOf(const YAML::Node& old, YAML::NodeType::value type) {
    YAML::Node copy(type);
    if (const std::string* origin = all_->OriginOf(old)) {
      all_->origins_.emplace_back(copy, *origin);
    }
    return copy;
  }

  // `node`, which is at `path`, with what is at `rest` below it changed.
  YAML::Node Changed(const YAML::Node& node, const std::string& path, std::string_view rest) {
    if (rest.empty()) return Ours(value_);
    if (node.IsSequence()) return ChangedList(node, path, rest);
    if (node.IsMap() || node.IsNull()) return ChangedMap(node, path, rest);
    Fail(path + " has no keys or elements; end the key there");
  }

  YAML::Node ChangedMap(const YAML::Node& map, const std::string& path, std::string_view rest) {
    const std::string key = KeyIn(map, path, rest);
    const std::string_view more = After(rest.substr(key.size()));
    YAML::Node copy = CopyOf(map, YAML::NodeType::Map);
    bool found = false;
    for (const auto& pair : map) {
      if (!pair.first.IsScalar() || pair.first.Scalar() != key) {
        copy.force_insert(pair.first, pair.second);
        continue;
      }
      found = true;
      if (!Removes(more))
        copy.force_insert(pair.first, Changed(pair.second, Below(path, key), more));
    }
    if (found) return copy;
    if (Removes(more) || (!more.empty() && HoldsNames(path))) Fail(ThereIsNo(key, map, path));
    const YAML::Node made = more.empty() ? value_ : ChangedMap({}, Below(path, key), more);
    copy.force_insert(YAML::Node(key), Ours(made));
    return copy;
  }

  YAML::Node ChangedList(const YAML::Node& list, const std::string& path, std::string_view rest) {
    std::size_t index = 0;
    const char* const end = rest.data() + rest.size();
    const auto [stop, error] = std::from_chars(rest.data(), end, index);
    std::string_view more = rest.substr(static_cast<std::size_t>(stop - rest.data()));
    if (more.starts_with(']')) more.remove_prefix(1);
    if (error != std::errc() || index > list.size() || !EndsKey(more)) {
      Fail(path + " is a list of " + std::to_string(list.size()) + "; write " + path +
           ".0 for its first element, or ." + std::to_string(list.size()) + " for one more");
    }
    more = After(more);
    YAML::Node copy = CopyOf(list, YAML::NodeType::Sequence);
    for (std::size_t i = 0; i < list.size(); ++i) {
      if (i != index) {
        copy.push_back(list[i]);
      } else if (!Removes(more)) {
        copy.push_back(Changed(list[i], path + "[" + std::to_string(i) + "]", more));
      }
    }
    if (index == list.size()) {
      if (!more.empty() || Removes(more)) Fail(path + " has no element " + std::to_string(index));
      copy.push_back(Ours(value_));
    }
    return copy;
  }

  // The key that `rest` begins with: the longest of the keys that are there, or else the text
  // before the next dot.
  std::string KeyIn(const YAML::Node& map, const std::string& path, std::string_view rest) const {
    std::optional<std::string> longest;
    for (const auto& pair : map) {
      if (!pair.first.IsScalar()) continue;
      const std::string& key = pair.first.Scalar();
      if (!rest.starts_with(key) || !EndsKey(rest.substr(key.size()))) continue;
      if (!longest || key.size() > longest->size()) longest = key;
    }
    if (longest) return *longest;
    const std::string_view key = rest.substr(0, rest.find_first_of(".["));
    if (key.empty()) Fail(Quote(path_) + " is not a key path: a key is missing in it");
    if (rest.substr(key.size()).starts_with('[')) Fail(ThereIsNo(std::string(key), map, path));
    return std::string(key);
  }

  std::string ThereIsNo(const std::string& key, const YAML::Node& map,
                        const std::string& path) const {
    std::vector<std::string> known;
    for (const auto& pair : map) {
      if (pair.first.IsScalar()) known.push_back(pair.first.Scalar());
    }
    const std::string sentence =
        "there is no " + Quote(key) + (path.empty() ? " in the scenario" : " in " + path);
    return known.empty() ? sentence + ", which is empty; check the path"
                         : sentence + "; " + Suggest(key, known, "keys");
  }

  // A path without the dot or bracket that leads on.
  std::string_view After(std::string_view rest) const {
    if (rest.empty()) return rest;
    if (rest.size() == 1) Fail(Quote(path_) + " ends with " + Quote(rest) + "; say what follows");
    return rest.substr(1);
  }

  bool Removes(std::string_view more) const { return more.empty() && value_.IsNull(); }

  static std::string Below(const std::string& path, const std::string& key) {
    return path.empty() ? key : path + "." + key;
  }

  const std::string origin_;
  SetOptions* all_;
  std::string path_;
  YAML::Node value_;
};

std::vector<Setting> SettingsOfOptions(const std::vector<std::string>& options) {
  std::vector<Setting> settings;
  for (const std::string& option : options) settings.push_back({option, Shown(option)});
  return settings;
}

YAML::Node SetOptions::Apply(const YAML::Node& root, const std::vector<Setting>& settings) {
  YAML::Node tree = root;
  for (const Setting& setting : settings) tree.reset(SetOption(setting, this).ApplyTo(tree));
  return tree;
}

const std::string* SetOptions::OriginOf(const YAML::Node& node) const {
  for (const auto& [origin, option] : origins_) {
    if (origin.is(node)) return &option;
  }
  return nullptr;
}

}  // namespace tcs
