#include "coordinator/trials/progress.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "coordinator/text/as_time.h"

namespace tcs {

namespace {

constexpr std::size_t kBar = 24;
// A smaller part of a trial than this says little about how long the trial takes.
constexpr double kTellingFraction = 0.02;

double Mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

}  // namespace

std::optional<double> RemainingSeconds(const TrialsProgress& progress) {
  std::vector<double> lengths = progress.finished_seconds;
  for (const auto& running : progress.running) {
    if (running.fraction >= kTellingFraction) lengths.push_back(running.seconds / running.fraction);
  }
  const int ended = progress.done + progress.failed;
  const int waiting = progress.total - ended - static_cast<int>(progress.running.size());
  if (lengths.empty()) return {};
  const double length = Mean(lengths);
  double work = length * waiting, longest = 0.0;
  for (const auto& running : progress.running) {
    const double left = running.fraction >= kTellingFraction
                            ? running.seconds / running.fraction - running.seconds
                            : std::max(0.0, length - running.seconds);
    work += left;
    longest = std::max(longest, left);
  }
  return std::max(longest, work / progress.at_once);
}

std::string AsSpan(std::int64_t ns) {
  if (ns < 1'000) return fmt::format("{} ns", ns);
  if (ns < 1'000'000'000) return fmt::format("{:.3f} ms", static_cast<double>(ns) * 1e-6);
  return fmt::format("{:.3f} s", static_cast<double>(ns) * 1e-9);
}

std::string ProgressLine(const TrialsProgress& progress, std::size_t columns) {
  double share = progress.done + progress.failed;
  for (const auto& running : progress.running) share += std::clamp(running.fraction, 0.0, 1.0);
  share /= std::max(1, progress.total);
  const auto full = static_cast<std::size_t>(share * static_cast<double>(kBar));
  std::string text =
      fmt::format("[{:.<{}}] {} of {} done, {} running", std::string(std::min(full, kBar), '#'),
                  kBar, progress.done, progress.total, progress.running.size());
  if (progress.queued > 0) text += fmt::format(", {} queued", progress.queued);
  if (progress.failed > 0) text += fmt::format(", {} failed", progress.failed);
  text += "  " + AsTime(progress.elapsed_seconds);
  if (const auto left = RemainingSeconds(progress)) text += ", about " + AsTime(*left) + " to go";
  if (text.size() > columns) text.resize(columns);
  return text;
}

std::string TrialsTable(const std::vector<TrialsGroup>& groups) {
  std::size_t width = 6;
  for (const TrialsGroup& group : groups) width = std::max(width, group.label.size());
  std::string text =
      fmt::format("{:<{}}  {:>9}  {:>17}  {:>11}  {:>13}  {:>8}\n", "trials", width, "done",
                  "real time of each", "drift, max", "staleness, max", "overhead");
  for (const TrialsGroup& group : groups) {
    const std::string done = fmt::format("{} of {}", group.done.size(), group.trials);
    if (group.done.empty()) {
      text += fmt::format("{:<{}}  {:>9}\n", group.label, width, done);
      continue;
    }
    std::vector<double> seconds, overheads;
    std::int64_t drift_ns = 0, staleness_ns = 0;
    for (const TrialOutcome& outcome : group.done) {
      seconds.push_back(static_cast<double>(outcome.real_ns) * 1e-9);
      overheads.push_back(outcome.overhead_percent);
      drift_ns = std::max(drift_ns, outcome.drift_ns);
      staleness_ns = std::max(staleness_ns, outcome.staleness_ns);
    }
    text +=
        fmt::format("{:<{}}  {:>9}  {:>15.3f} s  {:>11}  {:>14}  {:>6.2f} %\n", group.label, width,
                    done, Mean(seconds), AsSpan(drift_ns), AsSpan(staleness_ns), Mean(overheads));
  }
  return text;
}

}  // namespace tcs
