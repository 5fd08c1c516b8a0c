#include "coordinator/report/measure_data.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "coordinator/report/style.h"
#include "coordinator/report/varied.h"

namespace tcs::report {

namespace {

constexpr std::size_t kMostChosen = 3;   // figures that nobody asked for
constexpr std::size_t kMostPanels = 12;  // of one figure

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

// The measures whose values are the greatest in sum, of all whose names end with `ending`.
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

// The missed deadlines, if any were missed; else the slowest response of those with a deadline, or
// of all.
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
    const std::string key = varied.TellingKey();
    if (std::find(keys.begin(), keys.end(), key) == keys.end()) keys.push_back(key);
  }
  return keys;
}

// Makes the plot of one measure against one key.
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
      return ValueAsNumber(value).has_value();
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
    if (data_.is_numeric) return *ValueAsNumber(value);
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

  // A name has the same colour in all panels.
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
  std::vector<std::string> curves_;                           // the names of the curves
  std::optional<double> deadline_;
  bool has_one_deadline_ = true;
};

}  // namespace

std::vector<MeasurePlotData> MeasurePlots(const Results& results, const MeasureRequest& request) {
  const std::vector<Varied> all = AllVaried(results);
  if (all.empty()) return {};
  std::vector<std::string> keys;
  if (request.against.empty()) {
    keys = ChosenKeys(all);
  } else {
    keys.push_back(FindName(request.against, KeysOf(all), "varied key").name);
  }
  std::vector<std::string> measures;
  for (const std::string& name : request.measures) {
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

std::string WhyNoMeasure(const Results& results, const MeasureRequest& request) {
  if (request.measures.empty() && request.against.empty()) return {};
  const std::vector<Varied> all = AllVaried(results);
  if (all.empty()) {
    return "--measure and --against are for trials in which something was varied (tcsim trials "
           "--vary KEY=V1,V2); these folders have none";
  }
  if (!request.against.empty()) {
    const auto found = FindName(request.against, KeysOf(all), "varied key");
    if (!found.why_not.empty()) return "--against: " + found.why_not;
  }
  for (const std::string& name : request.measures) {
    const auto found = FindName(name, MeasureNames(all), "measure");
    if (!found.why_not.empty()) return "--measure: " + found.why_not;
  }
  return {};
}

}  // namespace tcs::report
