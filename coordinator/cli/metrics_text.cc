#include "coordinator/cli/metrics_text.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "coordinator/text/text_table.h"

namespace tcs {

namespace {

constexpr std::size_t kMostRows = 30;

std::string Number(double value) { return fmt::format("{:.4g}", value); }

std::string Second(std::int64_t ns) {
  return ns < 0 ? "never" : fmt::format("{:.3f} s", static_cast<double>(ns) * 1e-9);
}

std::string_view NameOf(MetricFigure figure) {
  return kMetricFigureNames[static_cast<std::size_t>(figure)];
}

// The figure that the scenario asked for.
std::string Answer(const MetricFigures& f) {
  if (f.from != kMetricFromScenario) return "-";
  if (f.asked == MetricFigure::kFirstTimeWhen) return Second(f.first_time_ns);
  if (f.count == 0) return "no values";
  const double value = f.asked == MetricFigure::kMin    ? f.min
                       : f.asked == MetricFigure::kMax  ? f.max
                       : f.asked == MetricFigure::kMean ? f.mean
                       : f.asked == MetricFigure::kRms  ? f.rms
                                                        : f.last;
  return fmt::format("{} {}", NameOf(f.asked), Number(value));
}

}  // namespace

std::string MetricsTable(const MetricsOfRun& metrics) {
  if (metrics.empty()) return {};
  TextTable table({{"metric", false},
                   {"from", false},
                   {"asked"},
                   {"values"},
                   {"last"},
                   {"min"},
                   {"max"},
                   {"mean"},
                   {"rms"}});
  std::size_t rows = 0;
  for (const auto& [name, f] : metrics) {
    if (++rows > kMostRows) continue;
    const auto number = [&f = f](double value) { return f.count == 0 ? "-" : Number(value); };
    table.Row({name, f.from, Answer(f), std::to_string(f.count), number(f.last), number(f.min),
               number(f.max), number(f.mean), number(f.rms)});
  }
  if (rows > kMostRows) {
    table.Note(fmt::format("and {} more, in summary.json", rows - kMostRows));
  }
  return table.Text();
}

nlohmann::ordered_json MetricsJson(const MetricsOfRun& metrics) {
  using Json = nlohmann::ordered_json;
  Json all = Json::object();
  for (const auto& [name, f] : metrics) {
    const auto number = [&f = f](double value) { return f.count == 0 ? Json() : Json(value); };
    Json& json = all[name];
    json["from"] = f.from;
    if (f.from == kMetricFromScenario) json["asked"] = NameOf(f.asked);
    json["count"] = f.count;
    json["last"] = number(f.last);
    json["min"] = number(f.min);
    json["max"] = number(f.max);
    json["mean"] = number(f.mean);
    json["rms"] = number(f.rms);
    json["first_time_ns"] = f.first_time_ns < 0 ? Json() : Json(f.first_time_ns);
  }
  return all;
}

}  // namespace tcs
