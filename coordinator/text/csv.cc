#include "coordinator/text/csv.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <system_error>
#include <utility>

namespace tcs {

void SplitCsv(std::string_view line, CsvFields* fields) {
  fields->clear();
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  for (;;) {
    const std::size_t comma = line.find(',');
    fields->push_back(line.substr(0, comma));
    if (comma == std::string_view::npos) return;
    line.remove_prefix(comma + 1);
  }
}

std::optional<double> ToReal(std::string_view text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value)) return {};
  return value;
}

std::optional<std::int64_t> ToInteger(std::string_view text) {
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return {};
  return value;
}

bool IsFile(const std::string& path) {
  std::error_code error;
  return std::filesystem::is_regular_file(path, error);
}

std::optional<std::string> ReadFile(const std::string& path) {
  // What else has a name may never come to an end.
  if (!IsFile(path)) return {};
  std::ifstream file(path, std::ios::binary);
  if (!file) return {};
  std::ostringstream text;
  text << file.rdbuf();
  if (file.bad()) return {};
  return std::move(text).str();
}

LoadResult<std::int64_t> ReadCsv(const std::string& path,
                                 const std::vector<std::string_view>& columns,
                                 const std::function<bool(const CsvFields&)>& take) {
  const std::optional<std::string> text = ReadFile(path);
  if (!text) return LoadError{fmt::format("{} cannot be read: {}", path, strerror(errno))};
  std::string_view rest = *text;
  std::int64_t unusable = 0;
  std::vector<std::size_t> places;
  CsvFields line, wanted(columns.size());
  for (bool is_header = true; !rest.empty(); is_header = false) {
    const std::size_t end = rest.find('\n');
    if (end == std::string_view::npos) {
      ++unusable;
      break;
    }
    SplitCsv(rest.substr(0, end), &line);
    rest.remove_prefix(end + 1);
    if (is_header) {
      for (const std::string_view column : columns) {
        const auto found = std::find(line.begin(), line.end(), column);
        if (found == line.end()) {
          return LoadError{fmt::format("{} has no column '{}'; is it tcsim's?", path, column)};
        }
        places.push_back(static_cast<std::size_t>(found - line.begin()));
      }
      continue;
    }
    const std::size_t needed = *std::max_element(places.begin(), places.end());
    if (line.size() <= needed) {
      ++unusable;
      continue;
    }
    for (std::size_t i = 0; i < places.size(); ++i) wanted[i] = line[places[i]];
    if (!take(wanted)) ++unusable;
  }
  if (places.empty()) return LoadError{fmt::format("{} is empty", path)};
  return unusable;
}

}  // namespace tcs
