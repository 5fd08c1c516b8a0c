#include "coordinator/text/yaml_text.h"

#include <algorithm>
#include <array>
#include <cctype>

namespace tcs {
namespace {

// What YAML's readers, today's and those of YAML 1.1, take for something other than a text.
constexpr std::array kOthers = {"null", "true", "false", "yes", "no", "on", "off", "y", "n"};

bool IsPlain(std::string_view text) {
  const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  const auto goes_on = [&](char c) {
    return is_letter(c) || (c >= '0' && c <= '9') || c == '_' || c == '-' || c == '.' || c == '/';
  };
  const auto is_other = [text](std::string_view other) {
    return std::ranges::equal(text, other, {}, [](unsigned char c) { return std::tolower(c); });
  };
  return !text.empty() && is_letter(text[0]) && std::ranges::all_of(text, goes_on) &&
         std::ranges::none_of(kOthers, is_other);
}

}  // namespace

std::string YamlText(std::string_view text) {
  if (IsPlain(text)) return std::string(text);
  std::string quoted = "'";
  for (const char c : text) {
    quoted += c;
    if (c == '\'') quoted += c;
  }
  return quoted + "'";
}

}  // namespace tcs
