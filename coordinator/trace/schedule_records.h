// Which thread had the processor when, written while the run goes: a picture of virtual time
// (trace.json) and a table with the real time beside it (dispatches.csv).
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>

#include "coordinator/trace/dispatch_log.h"
#include "coordinator/trace/schedule_trace.h"

namespace tcs {

class ScheduleRecords {
 public:
  using Span = DispatchLog::Span;
  struct TscSpan {
    std::uint64_t since, until;
  };

  // Without real times two deterministic runs write the same bytes. Empty on success, else one
  // sentence.
  [[nodiscard]] std::string Open(const std::string& directory, bool with_real_times);
  // Real times count from `tsc` on.
  void StartAt(std::uint64_t tsc, double ticks_per_ns);

  // A new row, or the row of that name: children come and go, and take over the names of children
  // that have gone.
  int AddRow(const std::string& group, const std::string& name);

  // `shown` is on the clock of the thread that ran, `world` on the world's, which may stand still
  // meanwhile.
  void Slice(int row, Span shown, Span world, TscSpan real);
  // `what` is a literal.
  void Instant(int row, const char* what, std::int64_t at_ns);

  // Writes what is noted, so that the files of a run that is killed end shortly before the kill.
  void Flush();
  [[nodiscard]] std::string Close();

 private:
  ScheduleTrace trace_;
  DispatchLog dispatches_;
  std::map<std::pair<std::string, std::string>, int> rows_;  // by group and name
  std::uint64_t start_tsc_ = 0;
  double ticks_per_ns_ = 1.0;
};

}  // namespace tcs
