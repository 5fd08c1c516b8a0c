#include "coordinator/scenario/load_outside.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <vector>

namespace tcs {

namespace {

bool IsHostAndPort(const std::string& text) {
  const std::size_t colon = text.rfind(':');
  if (colon == std::string::npos || colon == 0 || colon + 1 == text.size() ||
      text.find('/') != std::string::npos) {
    return false;
  }
  return std::all_of(text.begin() + static_cast<std::ptrdiff_t>(colon) + 1, text.end(),
                     [](unsigned char c) { return std::isdigit(c) != 0; });
}

}  // namespace

std::string TakeOutsideName(const std::string& text, const std::string& folder, std::string* name) {
  if (text.empty() || text == "@") {
    return "is empty; name a file or a socket by its path, an abstract socket by @NAME, or a peer "
           "by "
           "ADDRESS:PORT";
  }
  const bool is_path = text[0] != '@' && !IsHostAndPort(text);
  *name = is_path ? (std::filesystem::path(folder) / text).lexically_normal().string() : text;
  return "";
}

OutsideSpec LoadOutside(const YamlValue& value, const Variables& variables) {
  OutsideSpec outside;
  const YamlValue* names = &value;
  if (value.IsMap()) {
    const YamlMap map = value.AsMap();
    map.AllowOnly({"names", "takes", "patience"});
    names = map.Find("names");
    if (const YamlValue* v = map.Find("takes")) outside.takes = v->AsPositiveDuration();
    if (const YamlValue* v = map.Find("patience")) {
      outside.patience = HostDuration::Nanoseconds(v->AsPositiveDuration().ns());
    }
  }
  if (names == nullptr) return outside;
  for (const YamlValue& each : names->AsList("[/dev/ttyUSB0, 127.0.0.1:8000]")) {
    std::string name;
    const std::string mistake =
        TakeOutsideName(Substitute(each, variables), variables.scenario_directory, &name);
    if (!mistake.empty()) each.Fail(mistake);
    outside.names.push_back(name);
  }
  return outside;
}

}  // namespace tcs
