#include "coordinator/channel/json/json_text.h"

#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>
#include <utility>

namespace tcs {

void AppendNumber(double value, std::string& text) {
  if (!std::isfinite(value)) {
    text += "null";
    return;
  }
  const std::size_t begin = text.size();
  fmt::format_to(std::back_inserter(text), "{}", value);
  if (text.find_first_of(".e", begin) == std::string::npos) text += ".0";
}

void AppendList(std::span<const double> values, std::string& text) {
  if (values.empty()) {
    text += "[]";
    return;
  }
  char before = '[';
  for (const double value : values) {
    text += std::exchange(before, ',');
    AppendNumber(value, text);
  }
  text += ']';
}

// Divided, not multiplied by 1e-9: the double nearest to the decimal fraction.
JsonObject::JsonObject(VirtualTime at) { Add("time", static_cast<double>(at.ns()) / 1e9); }

void JsonObject::Begin(std::string_view key) {
  if (text_.size() > 1) text_ += ',';
  text_ += '"';
  text_ += key;
  text_ += "\":";
}

void JsonObject::Add(std::string_view key, double value) {
  Begin(key);
  AppendNumber(value, text_);
}

void JsonObject::Add(std::string_view key, std::span<const double> values) {
  Begin(key);
  AppendList(values, text_);
}

void JsonObject::Add(std::string_view key, const std::string& value) {
  Begin(key);
  text_ += nlohmann::json(value).dump();
}

void JsonObject::AddRaw(std::string_view key, std::string_view value) {
  Begin(key);
  text_ += value;
}

}  // namespace tcs
