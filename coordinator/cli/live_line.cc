#include "coordinator/cli/live_line.h"

#include <fmt/format.h>

namespace tcs {

namespace {

// Of being behind a pace.
constexpr std::int64_t kWorthSayingNs = 50'000'000;

double Seconds(std::int64_t ns) { return static_cast<double>(ns) * 1e-9; }

}  // namespace

std::string LiveLine::Text(const RunProgress& progress, std::size_t columns) {
  const double passed_ns = static_cast<double>(progress.virtual_ns - last_virtual_ns_);
  std::string text = fmt::format("{:.1f} of {:.1f} s  {:.2f} x real time  drift {:.3f} ms",
                                 Seconds(progress.virtual_ns), Seconds(duration_ns_),
                                 progress.real_ns > 0 ? static_cast<double>(progress.virtual_ns) /
                                                            static_cast<double>(progress.real_ns)
                                                      : 0.0,
                                 Seconds(progress.drift_ns) * 1e3);
  if (progress.pace.stands) {
    text += "  paused";
  } else if (progress.pace.late_ns > kWorthSayingNs) {
    text += fmt::format("  {:.1f} s behind pace {:g}", Seconds(progress.pace.late_ns),
                        progress.pace.pace);
  }
  for (const RunProgress::Load& load : progress.clients) {
    std::int64_t& last_ns = last_charged_ns_[load.client];
    const double share =
        passed_ns > 0 ? static_cast<double>(load.charged_ns - last_ns) / passed_ns : 0.0;
    text += fmt::format("  {} {:.0f} %", load.client, 100.0 * share);
    last_ns = load.charged_ns;
  }
  last_virtual_ns_ = progress.virtual_ns;
  if (text.size() > columns) text.resize(columns);
  return text;
}

void LiveLine::Show(const RunProgress& progress) {
  line_.Show(Text(progress, TerminalLine::Columns()));
}

}  // namespace tcs
