#include "coordinator/trace/schedule_records.h"

namespace tcs {

std::string ScheduleRecords::Open(const std::string& directory, bool with_real_times) {
  std::string error = trace_.Open(directory + "/trace.json");
  if (error.empty()) error = dispatches_.Open(directory + "/dispatches.csv", with_real_times);
  return error;
}

void ScheduleRecords::StartAt(std::uint64_t tsc, double ticks_per_ns) {
  start_tsc_ = tsc;
  ticks_per_ns_ = ticks_per_ns;
}

int ScheduleRecords::AddRow(const std::string& group, const std::string& name) {
  const auto [row, is_new] = rows_.try_emplace({group, name}, 0);
  if (is_new) {
    dispatches_.AddRow(name);
    row->second = trace_.AddRow(group, name);
  }
  return row->second;
}

void ScheduleRecords::Slice(int row, Span shown, Span world, TscSpan real) {
  trace_.Slice(row, shown.start_ns, shown.end_ns);
  if (!dispatches_.is_open()) return;
  const auto real_ns = [this](std::uint64_t tsc) {
    return static_cast<std::int64_t>(static_cast<double>(tsc - start_tsc_) / ticks_per_ns_);
  };
  dispatches_.Slice(row, world, {real_ns(real.since), real_ns(real.until)});
}

void ScheduleRecords::Instant(int row, const char* what, std::int64_t at_ns) {
  trace_.Instant(row, what, at_ns);
}

void ScheduleRecords::Flush() {
  trace_.Flush();
  dispatches_.Flush();
}

std::string ScheduleRecords::Close() {
  std::string error = trace_.Close();
  std::string second = dispatches_.Close();
  return error.empty() ? second : error;
}

}  // namespace tcs
