#include "coordinator/metrics/line_finder.h"

#include <string.h>

#include "coordinator/metrics/metric_line.h"

namespace tcs {

namespace {

// One byte more than a metric line may have: a line that is too long can be told by its length.
constexpr std::size_t kMostKept = kLongestMetricLine + 1;

// Whether the line that has begun may become a metric line.
bool MayBeMetric(std::string_view begun) {
  return begun.size() < kMetricWord.size() ? kMetricWord.starts_with(begun) : IsMetricLine(begun);
}

std::size_t LineEnd(std::string_view text, std::size_t from) {
  const void* end = memchr(text.data() + from, '\n', text.size() - from);
  return end == nullptr ? std::string_view::npos
                        : static_cast<std::size_t>(static_cast<const char*>(end) - text.data());
}

}  // namespace

void MetricLineFinder::Feed(std::string_view piece, const OnLine& on_line) {
  std::size_t at = 0;  // a line begins here, or goes on
  if (is_in_other_ || !begun_.empty()) {
    const std::size_t end = LineEnd(piece, 0);
    const std::string_view rest = piece.substr(0, end);
    if (!is_in_other_) {
      begun_ += rest.substr(0, kMostKept - begun_.size());
      if (!MayBeMetric(begun_)) {
        begun_.clear();
        is_in_other_ = true;
      }
    }
    if (end == std::string_view::npos) return;
    ++ended_;
    if (!is_in_other_ && IsMetricLine(begun_)) on_line(begun_, ended_);
    begun_.clear();
    is_in_other_ = false;
    at = end + 1;
  }
  for (std::size_t end; (end = LineEnd(piece, at)) != std::string_view::npos; at = end + 1) {
    ++ended_;
    const std::string_view line = piece.substr(at, end - at);
    if (IsMetricLine(line)) on_line(line.substr(0, kMostKept), ended_);
  }
  const std::string_view begun = piece.substr(at);
  is_in_other_ = !MayBeMetric(begun);
  if (!is_in_other_) begun_ = begun.substr(0, kMostKept);
}

void MetricLineFinder::Finish(const OnLine& on_line) {
  if (!is_in_other_ && IsMetricLine(begun_)) on_line(begun_, ended_ + 1);
  begun_.clear();
  is_in_other_ = false;
}

}  // namespace tcs
