#include "coordinator/report/varied.h"

#include <algorithm>
#include <set>
#include <utility>

#include "coordinator/scenario/duration.h"
#include "coordinator/text/csv.h"

namespace tcs::report {

namespace {

bool AreNumbersAll(const std::vector<std::string>& values) {
  return std::all_of(values.begin(), values.end(),
                     [](const std::string& value) { return ValueAsNumber(value).has_value(); });
}

// Sorts the cells by the first key's values first.
void SortCells(Varied* varied) {
  std::vector<std::vector<std::string>> order;
  for (std::size_t i = 0; i < varied->keys.size(); ++i) order.push_back(varied->ValuesOf(i));
  const auto places_of = [&order](const Varied::Cell& cell) {
    std::vector<std::ptrdiff_t> places;
    for (std::size_t i = 0; i < order.size(); ++i) {
      const auto at = std::find(order[i].begin(), order[i].end(), cell.values[i]);
      places.push_back(at - order[i].begin());
    }
    return places;
  };
  std::stable_sort(
      varied->cells.begin(), varied->cells.end(),
      [&](const Varied::Cell& a, const Varied::Cell& b) { return places_of(a) < places_of(b); });
}

}  // namespace

std::optional<double> ValueAsNumber(const std::string& text) {
  if (const auto number = ToReal(text)) return number;
  const auto duration = ParseDuration(text);
  if (const auto* parsed = std::get_if<VirtualDuration>(&duration)) return parsed->seconds();
  return {};
}

std::optional<std::size_t> Varied::PlaceOf(const std::string& key) const {
  const auto found = std::find(keys.begin(), keys.end(), key);
  if (found == keys.end()) return {};
  return static_cast<std::size_t>(found - keys.begin());
}

std::vector<std::string> Varied::ValuesOf(std::size_t key) const {
  std::vector<std::string> values;
  for (const Cell& cell : cells) {
    if (std::find(values.begin(), values.end(), cell.values[key]) == values.end()) {
      values.push_back(cell.values[key]);
    }
  }
  if (AreNumbersAll(values)) {
    std::stable_sort(values.begin(), values.end(), [](const std::string& a, const std::string& b) {
      return *ValueAsNumber(a) < *ValueAsNumber(b);
    });
  }
  return values;
}

std::string Varied::TellingKey() const {
  std::size_t most = 0;
  std::string telling = keys.front();
  for (std::size_t i = 0; i < keys.size(); ++i) {
    if (keys[i].ends_with(".speed")) return keys[i];
    const std::vector<std::string> values = ValuesOf(i);
    if (values.size() <= most || !AreNumbersAll(values)) continue;
    most = values.size();
    telling = keys[i];
  }
  return telling;
}

std::vector<Varied> AllVaried(const Results& results) {
  std::vector<Varied> all;
  for (const Sweep& sweep : results.sweeps) {
    Varied varied{sweep.name, {sweep.key}, {}};
    for (const SweepValue& value : sweep.values) {
      varied.cells.push_back({{value.text}, &value.system});
    }
    all.push_back(std::move(varied));
  }
  for (const Grid& grid : results.grids) {
    Varied varied{grid.name, grid.keys, {}};
    for (const GridCell& cell : grid.cells) varied.cells.push_back({cell.values, &cell.system});
    SortCells(&varied);
    all.push_back(std::move(varied));
  }
  return all;
}

std::vector<std::string> KeysOf(const std::vector<Varied>& all) {
  std::set<std::string> keys;
  for (const Varied& varied : all) keys.insert(varied.keys.begin(), varied.keys.end());
  return {keys.begin(), keys.end()};
}

std::vector<std::string> ShortKeys(const std::vector<std::string>& keys) {
  const auto end_of = [](const std::string& key, int parts) {
    std::size_t from = key.size();
    for (int i = 0; i < parts && from != std::string::npos && from != 0; ++i) {
      from = key.rfind('.', from - 1);
    }
    return from == std::string::npos || from == 0 ? key : key.substr(from + 1);
  };
  std::vector<std::string> ends;
  for (const std::string& key : keys) {
    int parts = 2;
    const auto is_shared = [&](const std::string& other) {
      return other != key && end_of(other, parts) == end_of(key, parts);
    };
    while (std::any_of(keys.begin(), keys.end(), is_shared)) ++parts;
    ends.push_back(end_of(key, parts));
  }
  return ends;
}

}  // namespace tcs::report
