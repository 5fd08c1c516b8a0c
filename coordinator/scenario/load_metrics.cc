// `metrics` of a scenario file: figures over bodies, joints and channels.
#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "coordinator/scenario/metric_names.h"
#include "coordinator/scenario/sections.h"

namespace tcs {

namespace {

constexpr std::string_view kMetricExample = "{rms: drone.z - 1.0}";

std::ptrdiff_t OpenParentheses(std::string_view text) {
  return std::ranges::count(text, '(') - std::ranges::count(text, ')');
}

struct AskedFigure {
  std::size_t figure;
  YamlValue value;
  std::string text;
};

// The map's figures, and its other entries. In a map in braces YAML cuts a text at its commas:
// `{max: norm(a.x, a.y)}` is the key `max` and a key `a.y)` without a value. The two parts are put
// together again.
std::vector<AskedFigure> TakeFigures(const YamlMap& map, std::vector<YamlMap::Entry>* others) {
  std::vector<AskedFigure> figures;
  const std::vector<YamlMap::Entry>& entries = map.entries();
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const auto name = std::ranges::find(kMetricFigureNames, entries[i].key);
    if (name == kMetricFigureNames.end()) {
      others->push_back(entries[i]);
      continue;
    }
    std::string text = entries[i].value.AsText();
    const YamlValue& value = entries[i].value;
    while (OpenParentheses(text) > 0 && i + 1 < entries.size() && entries[i + 1].value.IsNull()) {
      text += ", " + entries[++i].key;
    }
    figures.push_back({static_cast<std::size_t>(name - kMetricFigureNames.begin()), value, text});
  }
  return figures;
}

// `names`: null if the names are not known, because of mistakes elsewhere.
MetricSpec LoadMetric(const YamlMap::Entry& entry, MetricNames* names, Scenario* scenario) {
  CheckName(entry);
  const YamlMap map = entry.value.AsMap();
  std::vector<YamlMap::Entry> others;
  const std::vector<AskedFigure> figures = TakeFigures(map, &others);
  std::vector<std::string> keys(kMetricFigureNames.begin(), kMetricFigureNames.end());
  keys.insert(keys.end(), {"from", "until", "every"});
  const YamlMap rest(entry.value, std::move(others));
  rest.AllowOnly(keys);
  if (figures.empty()) {
    entry.value.Fail("asks for no figure; add min, max, mean, rms, last or first_time_when, like " +
                     std::string(kMetricExample));
  }
  if (figures.size() > 1) {
    figures[1].value.Fail("is a second figure, beside " +
                          std::string(kMetricFigureNames[figures[0].figure]) +
                          "; give it a metric of its own");
  }
  MetricSpec metric;
  metric.name = entry.key;
  metric.asked = static_cast<MetricFigure>(figures[0].figure);
  const YamlValue& value = figures[0].value;
  if (names == nullptr) return metric;
  auto parsed = metric.asked == MetricFigure::kFirstTimeWhen
                    ? ParseCondition(figures[0].text, *names)
                    : ParseExpression(figures[0].text, *names);
  if (const auto* sentence = std::get_if<std::string>(&parsed)) {
    value.FailPlainly(value.name() + ": " + *sentence);
  }
  metric.expression = std::move(std::get<Expression>(parsed));
  if (metric.expression.Needs().empty()) {
    value.Fail("names nothing that changes; write of what it is, like " +
               std::string(kMetricExample));
  }
  if (const YamlValue* from = rest.Find("from")) metric.from = from->AsDuration();
  if (const YamlValue* every = rest.Find("every")) metric.every = every->AsPositiveDuration();
  if (const YamlValue* until = rest.Find("until")) {
    metric.until = until->AsDuration();
    if (*metric.until < metric.from) until->Fail("is before from; correct one of them");
  }
  if (metric.from > scenario->duration) {
    scenario->warnings.push_back(value.place().Prefix() + entry.value.name() +
                                 " begins after the end of the run, so it has no values; correct "
                                 "its from, or the duration");
  }
  return metric;
}

}  // namespace

void LoadMetrics(const YamlMap& top, Scenario* scenario) {
  const YamlValue* value = top.Find("metrics");
  if (value == nullptr) return;
  const YamlMap map = value->AsMap();
  if (map.entries().empty()) return;
  if (!scenario->world) {
    value->Fail(
        "are of bodies, joints and channels, and there are none; add the key dynamics, or let a "
        "program print tcs-metric NAME VALUE");
  }
  const bool is_whole = !value->HasMistakes();
  std::vector<QuantitySpec> quantities;
  MetricNames names(*scenario, &quantities);
  map.ForEach([&](const YamlMap::Entry& entry) {
    scenario->metrics.push_back(LoadMetric(entry, is_whole ? &names : nullptr, scenario));
  });
  scenario->quantities = std::move(quantities);
}

}  // namespace tcs
