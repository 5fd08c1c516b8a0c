#include "coordinator/cli/live_line.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "coordinator/text/as_time.h"

namespace tcs {

namespace {

// How far a run has to be behind its pace for the line to say so.
constexpr std::int64_t kWorthSayingNs = 50'000'000;
constexpr double kWeight = 0.2;                     // of the last stretch among all before it
constexpr std::int64_t kTellingNs = 1'000'000'000;  // of real time, for a first guess

double AsSeconds(std::int64_t ns) { return static_cast<double>(ns) * 1e-9; }

}  // namespace

// The estimate goes by how fast the run has gone lately: a planner that starts or ends makes
// another run of it.
std::string LiveLine::ToGo(const RunProgress& progress) {
  const std::int64_t passed_ns = progress.real_ns - last_real_ns_;
  if (passed_ns > 0) {
    const double rate = static_cast<double>(progress.virtual_ns - last_virtual_ns_) /
                        static_cast<double>(passed_ns);
    rate_ = rate_ < 0 ? rate : (1 - kWeight) * rate_ + kWeight * rate;
  }
  last_real_ns_ = progress.real_ns;
  if (progress.real_ns < kTellingNs || rate_ <= 0) return {};
  const double left_s = AsSeconds(std::max<std::int64_t>(0, duration_ns_ - progress.virtual_ns));
  return "about " + AsTime(left_s / rate_) + " to go";
}

std::string LiveLine::Text(const RunProgress& progress, std::size_t columns) {
  const double passed_ns = static_cast<double>(progress.virtual_ns - last_virtual_ns_);
  std::string text = fmt::format("{:.1f} of {:.1f} virtual s", AsSeconds(progress.virtual_ns),
                                 AsSeconds(duration_ns_));
  if (text.size() > columns) text.resize(columns);
  // Adds an item whole or not at all, and returns whether there was room.
  const auto add = [&](const std::string& item) {
    const bool fits = text.size() + 2 + item.size() <= columns;
    if (fits && !item.empty()) text += "  " + item;
    return fits;
  };
  bool has_room = true;
  add(fmt::format("{:.2f} x real time", progress.real_ns > 0
                                            ? static_cast<double>(progress.virtual_ns) /
                                                  static_cast<double>(progress.real_ns)
                                            : 0.0));
  if (progress.pace.stands) {
    add("paused");
  } else if (progress.pace.late_ns > kWorthSayingNs) {
    add(fmt::format("{:.1f} s behind pace {:g}", AsSeconds(progress.pace.late_ns),
                    progress.pace.pace));
  } else {
    add(ToGo(progress));
  }
  // The clients that were the busiest in the whole run come first, so that they seldom change
  // places.
  std::vector<RunProgress::Load> loads = progress.clients;
  std::stable_sort(loads.begin(), loads.end(),
                   [](const auto& a, const auto& b) { return a.charged_ns > b.charged_ns; });
  for (const RunProgress::Load& load : loads) {
    std::int64_t& last_ns = last_charged_ns_[load.client];
    const double share =
        passed_ns > 0 ? static_cast<double>(load.charged_ns - last_ns) / passed_ns : 0.0;
    has_room = has_room && add(fmt::format("{} {:.0f} %", load.client, 100.0 * share));
    last_ns = load.charged_ns;
  }
  if (has_room) add(fmt::format("drift {:.3f} ms", AsSeconds(progress.drift_ns) * 1e3));
  last_virtual_ns_ = progress.virtual_ns;
  return text;
}

void LiveLine::Show(const RunProgress& progress) {
  line_.Show(Text(progress, TerminalLine::Columns()));
}

}  // namespace tcs
