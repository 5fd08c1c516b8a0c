#include "coordinator/channel/json/json_text.h"

#include <fmt/compile.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

namespace tcs {
namespace {

// Whether the letter stands for itself in a JSON string. Names of frames are made of such letters.
bool IsPlain(char letter) {
  return letter >= ' ' && letter <= '~' && letter != '"' && letter != '\\';
}

}  // namespace

void AppendNumber(double value, std::string& text) {
  if (!std::isfinite(value)) {
    text += "null";
    return;
  }
  std::array<char, 32> digits;  // a double has 24 at most
  char* end = fmt::format_to(digits.data(), FMT_COMPILE("{}"), value);
  const auto makes_it_real = [](char letter) { return letter == '.' || letter == 'e'; };
  if (std::none_of(digits.data(), end, makes_it_real)) {
    *end++ = '.';
    *end++ = '0';
  }
  text.append(digits.data(), end);
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
  if (std::ranges::all_of(value, IsPlain)) {
    text_ += '"';
    text_ += value;
    text_ += '"';
  } else {
    text_ += nlohmann::json(value).dump();
  }
}

void JsonObject::AddRaw(std::string_view key, std::string_view value) {
  Begin(key);
  text_ += value;
}

}  // namespace tcs
