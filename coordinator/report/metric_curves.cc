#include "coordinator/report/metric_curves.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "coordinator/text/csv.h"

namespace tcs::report {

namespace {

constexpr int kPieces = 400;

// The extreme values in a piece of the time.
struct PieceOfCurve {
  std::pair<double, double> least, greatest;  // s, and the value
  bool has_any = false;

  void Take(double time_s, double value) {
    if (!has_any || value < least.second) least = {time_s, value};
    if (!has_any || value > greatest.second) greatest = {time_s, value};
    has_any = true;
  }
};

std::optional<double> NumberAt(const nlohmann::json& metric, const std::string& key) {
  const auto found = metric.find(key);
  if (found == metric.end() || !found->is_number()) return {};
  return found->get<double>();
}

}  // namespace

std::map<std::string, MetricFigure> ReadMetricFigures(const std::string& folder) {
  std::map<std::string, MetricFigure> figures;
  const std::optional<std::string> text = ReadFile(folder + "/summary.json");
  if (!text) return figures;
  // The code that reads the run says what is wrong with the file.
  const auto json = nlohmann::json::parse(*text, nullptr, false);
  if (!json.is_object() || !json.contains("metrics") || !json["metrics"].is_object()) {
    return figures;
  }
  for (const auto& [name, metric] : json["metrics"].items()) {
    if (!metric.is_object()) continue;
    MetricFigure figure;
    const auto text_at = [&metric = metric](const char* key, const char* otherwise) {
      const auto found = metric.find(key);
      return found != metric.end() && found->is_string() ? found->get<std::string>() : otherwise;
    };
    figure.from = text_at("from", "");
    figure.asked = text_at("asked", "mean");
    figure.count = static_cast<std::int64_t>(NumberAt(metric, "count").value_or(0));
    figure.value = NumberAt(metric, figure.asked);
    if (figure.asked == "first_time_when") {
      figure.value = NumberAt(metric, "first_time_ns");
      if (figure.value) *figure.value *= 1e-9;
    }
    figures.emplace(name, std::move(figure));
  }
  return figures;
}

std::map<std::string, MetricCurve> ReadMetricCurves(
    const std::string& folder, double end_s, const std::map<std::string, MetricFigure>& metrics) {
  std::map<std::string, MetricCurve> curves;
  const std::string path = folder + "/metrics.csv";
  if (!IsFile(path) || end_s <= 0) return curves;
  std::map<std::string, std::vector<PieceOfCurve>> pieces;
  const auto take = [&](const CsvFields& fields) {
    const auto time_ns = ToInteger(fields[1]);
    const auto value = ToReal(fields[2]);
    if (!time_ns || !value) return false;
    // If several sources have a metric of one name, each metric is named with its source.
    std::string name(fields[0]);
    const auto known = metrics.find(name);
    if (known == metrics.end() || known->second.from != fields[3]) {
      name = std::string(fields[3]) + "/" + name;
      if (!metrics.contains(name)) return false;
    }
    std::vector<PieceOfCurve>& of = pieces[name];
    of.resize(kPieces);
    const double time_s = static_cast<double>(*time_ns) * 1e-9;
    const double at = std::clamp(time_s / end_s * kPieces, 0.0, kPieces - 1.0);
    of[static_cast<std::size_t>(at)].Take(time_s, *value);
    return true;
  };
  // A damaged table has no curves, and its figures stand in the other table.
  static_cast<void>(ReadCsv(path, {"name", "time_ns", "value", "from"}, take));
  for (const auto& [name, of] : pieces) {
    MetricCurve& curve = curves[name];
    for (const PieceOfCurve& piece : of) {
      if (!piece.has_any) continue;
      const auto [first, second] = std::minmax(piece.least, piece.greatest);
      curve.points.push_back(first);
      if (second != first) curve.points.push_back(second);
    }
  }
  return curves;
}

}  // namespace tcs::report
