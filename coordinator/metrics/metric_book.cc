#include "coordinator/metrics/metric_book.h"

#include <unistd.h>

namespace tcs {

void MetricBook::OpenIn(const std::string& folder) {
  path_ = folder + "/metrics.csv";
  unlink(path_.c_str());
}

int MetricBook::NumberOf(std::string_view from, std::string_view name, MetricFigure asked) {
  auto source = numbers_.find(from);
  if (source == numbers_.end()) source = numbers_.emplace(from, decltype(source->second){}).first;
  auto& names = source->second;
  if (const auto known = names.find(name); known != names.end()) return known->second;
  if (names.size() >= kMostOfOneSource) return -1;
  const int number = static_cast<int>(metrics_.size());
  names.emplace(name, number);
  metrics_.push_back({std::string(name), std::string(from),
                      MetricSums({.from = std::string(from), .asked = asked}), 0});
  return number;
}

bool MetricBook::Add(int metric, std::int64_t time_ns, double value, bool has_line,
                     bool may_be_first) {
  Metric& of = metrics_[static_cast<std::size_t>(metric)];
  of.sums.Add(time_ns, value, may_be_first);
  if (!has_line || path_.empty()) return true;
  if (of.lines >= kMostLines) return of.lines++ > kMostLines;
  ++of.lines;
  if (!csv_.is_open() && error_.empty()) error_ = csv_.Open(path_, "name,time_ns,value,from");
  csv_.Line(of.name, time_ns, value, of.from);
  return true;
}

std::string MetricBook::Close() {
  const std::string error = csv_.is_open() ? csv_.Close() : "";
  path_.clear();
  return error_.empty() ? error : error_;
}

MetricsOfRun MetricBook::Figures() const {
  std::map<std::string_view, int> sources;
  for (const Metric& metric : metrics_) {
    if (metric.from != kMetricFromExpectations) ++sources[metric.name];
  }
  MetricsOfRun figures;
  for (const Metric& metric : metrics_) {
    if (metric.from == kMetricFromExpectations) continue;
    const bool is_alone = metric.from == kMetricFromScenario || sources[metric.name] == 1;
    figures[is_alone ? metric.name : metric.from + "/" + metric.name] = metric.sums.figures();
  }
  return figures;
}

MetricsOfRun MetricBook::Expected() const {
  MetricsOfRun figures;
  for (const Metric& metric : metrics_) {
    if (metric.from == kMetricFromExpectations) figures[metric.name] = metric.sums.figures();
  }
  return figures;
}

}  // namespace tcs
