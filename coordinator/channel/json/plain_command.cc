#include "coordinator/channel/json/plain_command.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>
#include <functional>
#include <system_error>

namespace tcs {
namespace {

class Reader {
 public:
  explicit Reader(std::string_view text) : text_(text) {}

  bool Take(std::string_view what) {
    SkipBlanks();
    if (!text_.starts_with(what)) return false;
    text_.remove_prefix(what.size());
    return true;
  }
  // Takes a key or a text without escapes.
  std::optional<std::string_view> TakeText() {
    if (!Take("\"")) return std::nullopt;
    const std::size_t end = text_.find_first_of("\"\\");
    if (end == std::string_view::npos || text_[end] != '"') return std::nullopt;
    const std::string_view text = text_.substr(0, end);
    text_.remove_prefix(end + 1);
    return text;
  }
  bool IsAtEnd() {
    SkipBlanks();
    return text_.empty();
  }

  bool TakeNumber(double* value) {
    SkipBlanks();
    bool is_whole = false;
    const std::size_t length = NumberLength(&is_whole);
    if (length == 0) return false;
    const char* end = text_.data() + length;
    const auto result = std::from_chars(text_.data(), end, *value);
    if (result.ec != std::errc() || result.ptr != end) return false;
    if (is_whole) *value += 0.0;  // -0 is an integer, and so 0
    text_.remove_prefix(length);
    return true;
  }

  bool TakeVector(std::array<double, 3>* vector) {
    char before = '[';
    for (double& component : *vector) {
      if (!Take({&before, 1}) || !TakeNumber(&component)) return false;
      before = ',';
    }
    return Take("]");
  }

 private:
  void SkipBlanks() {
    const std::size_t first = text_.find_first_not_of(" \t\n\r");
    text_.remove_prefix(first == std::string_view::npos ? text_.size() : first);
  }

  // The length of a JSON number; from_chars takes others, too: nan, 01, .5.
  std::size_t NumberLength(bool* is_whole) const {
    std::size_t at = 0;
    const auto is = [&](char c) { return at < text_.size() && text_[at] == c; };
    const auto digits = [&] {
      const std::size_t begin = at;
      while (at < text_.size() && text_[at] >= '0' && text_[at] <= '9') ++at;
      return at > begin;
    };
    if (is('-')) ++at;
    if (is('0')) {
      ++at;
    } else if (!digits()) {
      return 0;
    }
    *is_whole = true;
    if (is('.')) {
      *is_whole = false;
      ++at;
      if (!digits()) return 0;
    }
    if (is('e') || is('E')) {
      *is_whole = false;
      ++at;
      if (is('+') || is('-')) ++at;
      if (!digits()) return 0;
    }
    return at;
  }

  std::string_view text_;
};

}  // namespace

std::optional<Wrench> ReadPlainCommand(std::string_view text) {
  Reader reader(text);
  Wrench wrench;
  if (!reader.Take("{")) return std::nullopt;
  if (!reader.Take("}")) {
    do {
      const bool is_force = reader.Take("\"force\"");
      if (!is_force && !reader.Take("\"torque\"")) return std::nullopt;
      if (!reader.Take(":")) return std::nullopt;
      if (!reader.TakeVector(is_force ? &wrench.force_n : &wrench.torque_nm)) return std::nullopt;
    } while (reader.Take(","));
    if (!reader.Take("}")) return std::nullopt;
  }
  if (!reader.IsAtEnd()) return std::nullopt;
  return wrench;
}

std::optional<std::vector<JointGoal>> ReadPlainGoals(std::string_view text,
                                                     std::span<const std::string> joints,
                                                     JointQuantity quantity) {
  Reader reader(text);
  std::vector<JointGoal> goals;
  if (!reader.Take("{")) return std::nullopt;
  if (!reader.Take("}")) {
    do {
      const auto name = reader.TakeText();
      if (!name || !reader.Take(":")) return std::nullopt;
      const auto joint = std::find(joints.begin(), joints.end(), *name);
      if (joint == joints.end()) return std::nullopt;
      JointGoal goal{static_cast<std::size_t>(joint - joints.begin())};
      if (!reader.TakeNumber(&goal.Of(quantity).emplace())) return std::nullopt;
      goals.push_back(goal);
    } while (reader.Take(","));
    if (!reader.Take("}")) return std::nullopt;
  }
  if (!reader.IsAtEnd()) return std::nullopt;
  // In the order of their names, as in a tree of values.
  const auto name_of = [&joints](const JointGoal& goal) -> const std::string& {
    return joints[goal.joint];
  };
  std::ranges::sort(goals, std::less(), name_of);
  const auto is_same = [&](const JointGoal& a, const JointGoal& b) { return a.joint == b.joint; };
  if (std::ranges::adjacent_find(goals, is_same) != goals.end()) return std::nullopt;
  return goals;
}

}  // namespace tcs
