#include "coordinator/report/measure_data.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <utility>

#include "coordinator/report/csv.h"
#include "coordinator/report/style.h"
#include "coordinator/scenario/duration.h"

namespace tcs::report {

namespace {

constexpr std::size_t kMostChosen = 3;   // figures without a wish
constexpr std::size_t kMostPanels = 12;  // of one figure

std::optional<double> AsNumber(const std::string& text) {
  if (const auto number = ToReal(text)) return number;
  const auto duration = ParseDuration(text);
  if (const auto* parsed = std::get_if<VirtualDuration>(&duration)) return parsed->seconds();
  return {};
}

// A sweep or a grid, as one thing.
struct Varied {
  std::string name;
  std::vector<std::string> keys;
  struct Cell {
    std::vector<std::string> values;
    const System* system = nullptr;
  };
  std::vector<Cell> cells;

  // Its place among the keys; none if it is not among them.
  [[nodiscard]] std::optional<std::size_t> PlaceOf(const std::string& key) const {
    const auto found = std::find(keys.begin(), keys.end(), key);
    if (found == keys.end()) return {};
    return static_cast<std::size_t>(found - keys.begin());
  }
  // The values of a key, in the order of the cells.
  [[nodiscard]] std::vector<std::string> ValuesOf(std::size_t key) const {
    std::vector<std::string> values;
    for (const Cell& cell : cells) {
      if (std::find(values.begin(), values.end(), cell.values[key]) == values.end()) {
        values.push_back(cell.values[key]);
      }
    }
    return values;
  }
};

// Values that are numbers in their order as such; others as they came.
bool ComesBefore(const Varied::Cell& a, const Varied::Cell& b) {
  for (std::size_t i = 0; i < a.values.size(); ++i) {
    const auto x = AsNumber(a.values[i]), y = AsNumber(b.values[i]);
    if (x && y && *x != *y) return *x < *y;
  }
  return false;
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
    std::stable_sort(varied.cells.begin(), varied.cells.end(), ComesBefore);
    all.push_back(std::move(varied));
  }
  return all;
}

bool IsSpeed(const std::string& key) { return key.ends_with(".speed"); }

// Of which a plot says most.
std::string TellingKey(const Varied& varied) {
  std::size_t most = 0;
  std::string telling = varied.keys.front();
  for (std::size_t i = 0; i < varied.keys.size(); ++i) {
    if (IsSpeed(varied.keys[i])) return varied.keys[i];
    const std::vector<std::string> values = varied.ValuesOf(i);
    const bool are_numbers =
        std::all_of(values.begin(), values.end(),
                    [](const std::string& value) { return AsNumber(value).has_value(); });
    if (are_numbers && values.size() > most) {
      most = values.size();
      telling = varied.keys[i];
    }
  }
  return telling;
}

template <class Take>
void ForEachRun(const std::vector<Varied>& all, const Take& take) {
  for (const Varied& varied : all) {
    for (const Varied::Cell& cell : varied.cells) {
      for (const Run& run : cell.system->runs) take(run);
    }
  }
}

std::vector<std::string> MeasureNames(const std::vector<Varied>& all) {
  std::set<std::string> names;
  ForEachRun(all, [&](const Run& run) {
    for (const auto& [name, measure] : run.measures) names.insert(name);
  });
  return {names.begin(), names.end()};
}

std::vector<std::string> KeysOf(const std::vector<Varied>& all) {
  std::set<std::string> keys;
  for (const Varied& varied : all) keys.insert(varied.keys.begin(), varied.keys.end());
  return {keys.begin(), keys.end()};
}

// Those whose values are the greatest in sum, of all that end so.
std::vector<std::string> Greatest(const std::vector<Varied>& all, std::string_view ending,
                                  bool with_deadline) {
  std::map<std::string, double> sums;
  ForEachRun(all, [&](const Run& run) {
    for (const auto& [name, measure] : run.measures) {
      if (!name.ends_with(ending)) continue;
      const std::string of = name.substr(0, name.size() - ending.size());
      if (with_deadline && !run.measures.contains(of + ".deadline")) continue;
      sums[name] += measure.value;
    }
  });
  std::erase_if(sums, [](const auto& sum) { return sum.second <= 0; });
  std::vector<std::pair<std::string, double>> sorted(sums.begin(), sums.end());
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const auto& a, const auto& b) { return a.second > b.second; });
  std::vector<std::string> names;
  for (const auto& [name, sum] : sorted) {
    if (names.size() < kMostChosen) names.push_back(name);
  }
  return names;
}

// Who was late, if anybody was; else the slowest of those who must not be, or of all.
std::vector<std::string> ChosenMeasures(const std::vector<Varied>& all) {
  std::vector<std::string> names = Greatest(all, ".missed", true);
  if (!names.empty()) return names;
  names = Greatest(all, ".response_p99", true);
  if (names.empty()) names = Greatest(all, ".response_p99", false);
  if (names.size() > 1) names.resize(1);
  return names;
}

std::vector<std::string> ChosenKeys(const std::vector<Varied>& all) {
  std::vector<std::string> keys;
  for (const Varied& varied : all) {
    const std::string key = TellingKey(varied);
    if (std::find(keys.begin(), keys.end(), key) == keys.end()) keys.push_back(key);
  }
  return keys;
}

// One measure against one key.
class PlotMaker {
 public:
  PlotMaker(const std::vector<Varied>& all, std::string measure, std::string against) {
    data_.measure = std::move(measure);
    data_.against = std::move(against);
    for (const Varied& varied : all) {
      const auto place = varied.PlaceOf(data_.against);
      if (place) shown_.emplace_back(&varied, *place);
    }
  }

  MeasurePlotData Take() {
    FindPlaces();
    for (const std::string& place : places_) data_.tried.emplace_back(AtOf(place), place);
    for (const auto& [varied, place] : shown_) TakeCells(*varied, place);
    for (MeasurePanel& panel : data_.panels) {
      for (MeasureCurve& curve : panel.curves) {
        std::stable_sort(curve.points.begin(), curve.points.end(),
                         [](const MeasurePoint& a, const MeasurePoint& b) { return a.at < b.at; });
      }
    }
    for (MeasurePanel& panel : data_.panels) {
      std::erase_if(panel.curves, [](const MeasureCurve& curve) { return curve.points.empty(); });
    }
    std::erase_if(data_.panels, [](const MeasurePanel& panel) { return panel.curves.empty(); });
    if (data_.panels.size() > kMostPanels) {
      data_.left_out = data_.panels.size() - kMostPanels;
      data_.panels.resize(kMostPanels);
    }
    if (data_.panels.size() == 1) data_.panels.front().title.clear();
    if (curves_.size() == 1) {
      for (MeasurePanel& panel : data_.panels) panel.curves.front().name.clear();
    }
    data_.deadline = has_one_deadline_ ? deadline_ : std::nullopt;
    return std::move(data_);
  }

 private:
  void FindPlaces() {
    for (const auto& [varied, place] : shown_) {
      for (const std::string& value : varied->ValuesOf(place)) {
        if (std::find(places_.begin(), places_.end(), value) == places_.end()) {
          places_.push_back(value);
        }
      }
    }
    data_.is_numeric = std::all_of(places_.begin(), places_.end(), [](const std::string& value) {
      return AsNumber(value).has_value();
    });
  }

  // The other key whose values are told apart by curves: the first that has few enough.
  static std::optional<std::size_t> CurveKey(const Varied& varied, std::size_t against) {
    for (std::size_t i = 0; i < varied.keys.size(); ++i) {
      if (i != against && varied.ValuesOf(i).size() <= kSeriesColours) return i;
    }
    return {};
  }

  void TakeCells(const Varied& varied, std::size_t against) {
    const auto curve_key = CurveKey(varied, against);
    const std::vector<std::string> ends = ShortKeys(varied.keys);
    if (curve_key) data_.curves_are = ends[*curve_key];
    for (const Varied::Cell& cell : varied.cells) {
      MeasurePoint point{cell.values[against], AtOf(cell.values[against]), {}};
      for (const Run& run : cell.system->runs) TakeRun(run, &point);
      data_.without_value += cell.system->runs.size() - point.values.size();
      std::vector<std::string> title;
      for (std::size_t i = 0; i < varied.keys.size(); ++i) {
        if (i == against || i == curve_key) continue;
        title.push_back(fmt::format("{} = {}", ends[i], cell.values[i]));
      }
      std::vector<std::string> name;
      if (shown_.size() > 1) name.push_back(varied.name);
      if (curve_key) name.push_back(cell.values[*curve_key]);
      MeasureCurve& curve = CurveIn(PanelOf(fmt::format("{}", fmt::join(title, ", "))),
                                    fmt::format("{}", fmt::join(name, ", ")));
      if (!point.values.empty()) curve.points.push_back(std::move(point));
    }
  }

  double AtOf(const std::string& value) const {
    if (data_.is_numeric) return *AsNumber(value);
    return static_cast<double>(std::find(places_.begin(), places_.end(), value) - places_.begin());
  }

  void TakeRun(const Run& run, MeasurePoint* point) {
    const auto found = run.measures.find(data_.measure);
    if (found == run.measures.end()) return;
    point->values.push_back(found->second.value);
    data_.unit = found->second.unit;
    const std::size_t dot = data_.measure.rfind('.');
    if (!data_.measure.substr(dot + 1).starts_with("response_")) return;
    const auto deadline = run.measures.find(data_.measure.substr(0, dot) + ".deadline");
    if (deadline == run.measures.end()) return;
    if (deadline_ && *deadline_ != deadline->second.value) has_one_deadline_ = false;
    deadline_ = deadline->second.value;
  }

  MeasurePanel& PanelOf(const std::string& title) {
    for (MeasurePanel& panel : data_.panels) {
      if (panel.title == title) return panel;
    }
    return data_.panels.emplace_back(MeasurePanel{title, {}});
  }

  // The same name has the same colour in all panels.
  MeasureCurve& CurveIn(MeasurePanel& panel, const std::string& name) {
    for (MeasureCurve& curve : panel.curves) {
      if (curve.name == name) return curve;
    }
    auto known = std::find(curves_.begin(), curves_.end(), name);
    if (known == curves_.end()) known = curves_.insert(curves_.end(), name);
    return panel.curves.emplace_back(
        MeasureCurve{name, static_cast<int>(known - curves_.begin()), {}});
  }

  MeasurePlotData data_;
  std::vector<std::pair<const Varied*, std::size_t>> shown_;  // and the place of the key
  std::vector<std::string> places_;                           // values of the key
  std::vector<std::string> curves_;                           // their names
  std::optional<double> deadline_;
  bool has_one_deadline_ = true;
};

// What stands behind the last dot, in words.
constexpr std::array<std::pair<std::string_view, std::string_view>, 12> kWords = {{
    {"missed", "missed deadlines"},
    {"misses", "missed deadlines"},
    {"misses_in_a_row", "deadlines missed in a row"},
    {"response", "response time"},
    {"start_delay", "start delay"},
    {"execution", "execution time"},
    {"command_age", "age of commands"},
    {"age", "age"},
    {"lost", "lost samples"},
    {"replaced", "replaced samples"},
    {"unread", "unread samples"},
    {"backlog", "greatest backlog"},
}};

std::string WordOf(std::string_view figure) {
  for (const auto& [name, words] : kWords) {
    if (figure == name) return std::string(words);
    for (const std::string_view quantile : {"_p50", "_p99", "_max"}) {
      if (figure == std::string(name) + std::string(quantile)) {
        return fmt::format("{} ({})", words, quantile.substr(1));
      }
    }
  }
  return {};
}

}  // namespace

std::vector<MeasurePlotData> MeasurePlots(const Results& results, const MeasureWish& wish) {
  const std::vector<Varied> all = AllVaried(results);
  if (all.empty()) return {};
  std::vector<std::string> keys;
  if (wish.against.empty()) {
    keys = ChosenKeys(all);
  } else {
    keys.push_back(FindName(wish.against, KeysOf(all), "varied key").name);
  }
  std::vector<std::string> measures;
  for (const std::string& name : wish.measures) {
    measures.push_back(FindName(name, MeasureNames(all), "measure").name);
  }
  if (measures.empty()) measures = ChosenMeasures(all);
  std::vector<MeasurePlotData> plots;
  for (const std::string& key : keys) {
    for (const std::string& measure : measures) {
      MeasurePlotData plot = PlotMaker(all, measure, key).Take();
      if (!plot.panels.empty()) plots.push_back(std::move(plot));
    }
  }
  return plots;
}

std::string WhyNoMeasure(const Results& results, const MeasureWish& wish) {
  if (wish.measures.empty() && wish.against.empty()) return {};
  const std::vector<Varied> all = AllVaried(results);
  if (all.empty()) {
    return "--measure and --against are for trials in which something was varied (tcsim trials "
           "--vary KEY=V1,V2); these folders have none";
  }
  if (!wish.against.empty()) {
    const auto found = FindName(wish.against, KeysOf(all), "varied key");
    if (!found.why_not.empty()) return "--against: " + found.why_not;
  }
  for (const std::string& name : wish.measures) {
    const auto found = FindName(name, MeasureNames(all), "measure");
    if (!found.why_not.empty()) return "--measure: " + found.why_not;
  }
  return {};
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

std::string MeasureWords(const std::string& measure) {
  const std::size_t dot = measure.rfind('.');
  if (dot == std::string::npos) return measure;
  const std::string words = WordOf(std::string_view(measure).substr(dot + 1));
  return words.empty() ? measure : fmt::format("{} of {}", words, measure.substr(0, dot));
}

}  // namespace tcs::report
