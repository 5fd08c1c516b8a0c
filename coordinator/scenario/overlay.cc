#include "coordinator/scenario/overlay.h"

#include <yaml-cpp/yaml.h>

#include <utility>

#include "coordinator/scenario/place.h"
#include "coordinator/scenario/yaml_reader.h"

namespace tcs {
namespace {

// Nobody writes overlays that are deeper; a deeper one would use up the stack.
constexpr int kDeepest = 32;
constexpr std::size_t kMostSettings = 10'000;  // aliases of aliases would be billions

// The value on one line, as --set takes it.
std::string InOneLine(const YAML::Node& value) {
  YAML::Emitter emitter;
  emitter.SetMapFormat(YAML::Flow);
  emitter.SetSeqFormat(YAML::Flow);
  emitter << value;
  return emitter.c_str();
}

class Overlay {
 public:
  explicit Overlay(std::string file) : file_(std::move(file)) {}

  void Collect(const YAML::Node& map, const std::string& path, int depth) {
    int line = map.Mark().is_null() ? 1 : map.Mark().line + 1;
    for (const auto& pair : map) {
      if (!pair.first.Mark().is_null()) line = pair.first.Mark().line + 1;
      const std::string place = Place{file_, line}.Prefix();
      if (!pair.first.IsScalar() || pair.first.Scalar().empty()) {
        throw ScenarioMistake{place + "this key is not a text; write a text"};
      }
      if (depth == kDeepest || settings_.size() == kMostSettings) {
        throw ScenarioMistake{place +
                              "this is deeper or larger than any scenario; look for YAML aliases "
                              "that repeat themselves"};
      }
      const std::string key = path.empty() ? pair.first.Scalar() : path + "." + pair.first.Scalar();
      if (pair.second.IsMap()) {
        Collect(pair.second, key, depth + 1);
      } else {
        const std::string value = pair.second.IsNull() ? "null" : InOneLine(pair.second);
        settings_.push_back({key + "=" + value, place.substr(0, place.size() - 2)});
      }
    }
  }

  std::vector<Setting> Take() { return std::move(settings_); }

 private:
  const std::string file_;
  std::vector<Setting> settings_;
};

}  // namespace

std::vector<Setting> SettingsOfOverlay(const std::string& file, const std::string& text) {
  const YAML::Node document = ParseDocument(file, text);
  if (!document.IsMap() && !document.IsNull()) {
    throw ScenarioMistake{Place{file, 1}.Prefix() +
                          "this is no piece of a scenario; write its keys, such as robots, and "
                          "those below them"};
  }
  Overlay overlay(file);
  if (document.IsMap()) overlay.Collect(document, "", 0);
  return overlay.Take();
}

}  // namespace tcs
