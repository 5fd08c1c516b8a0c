#include "coordinator/scenario/duration.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <optional>
#include <string>

namespace tcs {
namespace {

struct Unit {
  std::string_view name;
  std::int64_t multiplier;
  int power_of_ten;  // one unit is multiplier * 10^power_of_ten ns
};

constexpr std::array kUnits = {
    Unit{"", 1, 9},   Unit{"ns", 1, 0}, Unit{"us", 1, 3},   Unit{"µs", 1, 3},  // U+00B5
    Unit{"μs", 1, 3},                                                          // U+03BC
    Unit{"ms", 1, 6}, Unit{"s", 1, 9},  Unit{"min", 60, 9}, Unit{"h", 3600, 9},
};

constexpr std::string_view kExample = "write it like 20s, 1.5 s or 10ms";

bool IsDigit(char c) { return c >= '0' && c <= '9'; }
bool IsSpace(char c) { return c == ' ' || c == '\t'; }

std::string_view Trim(std::string_view text) {
  while (!text.empty() && IsSpace(text.front())) text.remove_prefix(1);
  while (!text.empty() && IsSpace(text.back())) text.remove_suffix(1);
  return text;
}

const Unit* FindUnit(std::string_view name) {
  for (const Unit& unit : kUnits) {
    if (unit.name == name) return &unit;
  }
  return nullptr;
}

// A decimal number as written: digits * 10^exponent.
struct Decimal {
  std::string digits;  // without leading zeros; empty is 0
  long exponent = 0;
};

// Takes an unsigned decimal number off the front of `text`; none if there is no number, or if its
// exponent is absurd.
std::optional<Decimal> TakeDecimal(std::string_view* text) {
  Decimal number;
  bool any_digit = false;
  bool after_point = false;
  std::size_t i = 0;
  for (; i < text->size(); ++i) {
    const char c = (*text)[i];
    if (c == '.' && !after_point) {
      after_point = true;
    } else if (IsDigit(c)) {
      any_digit = true;
      if (c != '0' || !number.digits.empty()) number.digits += c;
      if (after_point) --number.exponent;
    } else {
      break;
    }
  }
  if (!any_digit) return std::nullopt;
  text->remove_prefix(i);

  if (!text->empty() && (text->front() == 'e' || text->front() == 'E')) {
    std::string_view rest = text->substr(1);
    if (!rest.empty() && rest.front() == '+') rest.remove_prefix(1);
    int exponent = 0;
    const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), exponent);
    if (error != std::errc() || exponent > 1000 || exponent < -1000) return std::nullopt;
    rest.remove_prefix(static_cast<std::size_t>(end - rest.data()));
    number.exponent += exponent;
    *text = rest;
  }
  while (!number.digits.empty() && number.digits.back() == '0') {
    number.digits.pop_back();
    ++number.exponent;
  }
  return number;
}

}  // namespace

LoadResult<VirtualDuration> ParseDuration(std::string_view text) {
  const auto quoted = [text] { return "'" + std::string(text) + "'"; };
  const auto mistake = [&](std::string_view what) {
    return LoadError{quoted() + " " + std::string(what)};
  };

  std::string_view rest = Trim(text);
  if (!rest.empty() && rest.front() == '+') rest.remove_prefix(1);
  if (!rest.empty() && rest.front() == '-') {
    return mistake("is not a duration: it must not be negative");
  }
  std::optional<Decimal> number = TakeDecimal(&rest);
  if (!number) return mistake("is not a duration; " + std::string(kExample));

  const std::string_view unit_name = Trim(rest);
  const Unit* unit = FindUnit(unit_name);
  if (unit == nullptr) {
    return mistake("has the unknown unit '" + std::string(unit_name) +
                   "'; use ns, us, ms, s, min or h");
  }
  if (number->digits.empty()) return VirtualDuration{};

  const LoadError too_long = mistake("is too long a duration; the longest is 146 years");
  const LoadError too_fine = mistake("is not a whole number of nanoseconds; round it");
  long exponent = number->exponent + unit->power_of_ten;
  const long digits = static_cast<long>(number->digits.size());
  if (digits + exponent > 20) return too_long;
  if (digits > 30) return too_fine;  // 3600 makes four of its decimals whole at most
  __extension__ using Wide = __int128;
  Wide ns = 0;
  for (const char digit : number->digits) ns = ns * 10 + (digit - '0');
  ns *= unit->multiplier;
  for (; exponent < 0 && ns % 10 == 0; ++exponent) ns /= 10;
  if (exponent < 0) return too_fine;
  for (; exponent > 0; --exponent) ns *= 10;
  if (ns > kLongestDuration.ns()) return too_long;
  return VirtualDuration::Nanoseconds(static_cast<std::int64_t>(ns));
}

std::string SecondsText(std::int64_t ns) {
  constexpr std::int64_t kSecond_ns = 1'000'000'000;
  std::string text = fmt::format("{}.{:09}", ns / kSecond_ns, ns % kSecond_ns);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.ends_with('.')) text.pop_back();
  return text + "s";
}

}  // namespace tcs
