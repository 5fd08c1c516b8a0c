// All metrics of a run: their figures, and metrics.csv, which has their values.
//
// Not thread-safe.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "coordinator/metrics/metric_figures.h"
#include "coordinator/metrics/metric_sums.h"
#include "coordinator/trace/csv_file.h"

namespace tcs {

class MetricBook {
 public:
  // The most metrics of one source, and the most lines of one metric in the file.
  static constexpr std::size_t kMostOfOneSource = 1000;
  static constexpr std::int64_t kMostLines = 1'000'000;

  // The file will be in this folder, if there are values; the file of an earlier run is removed.
  void OpenIn(const std::string& folder);

  // The metric's number; a new metric has no values. -1: the source has too many already.
  int NumberOf(std::string_view from, std::string_view name,
               MetricFigure asked = MetricFigure::kLast);
  // IsMetricValue(value). `has_line`: the file has the value, too. `may_be_first`: first_time_ns
  // may be its time. False if the file lacks the value because it has too many values of this
  // metric; false only the first time.
  bool Add(int metric, std::int64_t time_ns, double value, bool has_line = true,
           bool may_be_first = true);

  void Flush() { csv_.Flush(); }
  // Empty on success, else one sentence.
  [[nodiscard]] std::string Close();

  [[nodiscard]] MetricsOfRun Figures() const;
  // The figures of the metrics from kMetricFromExpectations, which Figures() leaves out.
  [[nodiscard]] MetricsOfRun Expected() const;

 private:
  struct Metric {
    std::string name, from;
    MetricSums sums;
    std::int64_t lines = 0;
  };
  std::vector<Metric> metrics_;
  std::map<std::string, std::map<std::string, int, std::less<>>, std::less<>> numbers_;
  std::string path_, error_;  // empty path: there is no file
  CsvFile csv_;
};

}  // namespace tcs
