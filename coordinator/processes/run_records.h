// The records that a run writes about itself while it goes (docs/RESULTS.md): the schedule trace,
// the activations of clients, which thread had the processor when, when clients printed something,
// and what the world did. A run without a folder for its results writes nothing.
//
// For the coordinator's thread only. Errors are one sentence; empty is success.
#pragma once

#include <cstdint>
#include <string>

#include "coordinator/answers/response_log.h"
#include "coordinator/metrics/client_metrics.h"
#include "coordinator/metrics/metric_book.h"
#include "coordinator/tasks/activations.h"
#include "coordinator/tasks/run_clock.h"
#include "coordinator/tasks/run_state.h"
#include "coordinator/trace/output_log.h"
#include "coordinator/trace/schedule_records.h"
#include "coordinator/world/world.h"

namespace tcs {

class RunRecords {
 public:
  // On the clock of the program that ran, and on the world's, which may stand still meanwhile.
  struct ShownSpan {
    ProgramTime start, end;
  };
  struct WorldSpan {
    VirtualTime start, end;
  };
  using TscSpan = ScheduleRecords::TscSpan;

  RunRecords(RunState& run, World& world, Activations& activations)
      : run_(run), world_(world), activations_(activations) {}
  RunRecords(const RunRecords&) = delete;
  RunRecords& operator=(const RunRecords&) = delete;

  // Once the world is open; files that an earlier run has left there are removed.
  [[nodiscard]] std::string Open();
  // After Open, if at all. The feed, which is open, outlives this; the feed is told of each turn,
  // and what it tells of is written.
  [[nodiscard]] std::string Follow(AnswerFeed& answers);
  // From when real times count.
  void StartAt(const RunClock& clock);
  // So that the records of a run that is killed end shortly before. Of a run with set costs the
  // metrics that programs print follow at the run's end, in an order that is always the same,
  // unless somebody watches the run.
  void Flush(bool for_watchers);
  [[nodiscard]] std::string Close();
  // Once no client lives any more: what clients have printed to their end counts, at `end`.
  [[nodiscard]] std::string CloseMetrics(VirtualTime end);
  [[nodiscard]] MetricsOfRun Metrics() const { return metrics_.Figures(); }
  [[nodiscard]] MetricsOfRun Expected() const { return metrics_.Expected(); }

  // Where a thread is drawn: Task::row.
  int AddRow(const std::string& group, const std::string& name) {
    return schedule_.AddRow(group, name);
  }
  // The running thread has stopped at `until_tsc`. The thread may be settled again in the same
  // turn.
  void Ran(const Task& task, ShownSpan shown, WorldSpan world, std::uint64_t until_tsc);
  // A thread has a turn beside others. Until that turn ends, text that the thread's client writes
  // is of that turn, which has not ended.
  void BeganBeside(const Task& task) { output_.Hold(task.process->client->name); }
  void EndsBeside(const Task& task) { output_.LetGo(task.process->client->name); }
  // The dynamics were integrated.
  void Integrated(WorldSpan span, TscSpan real) {
    const ScheduleRecords::Span both{span.start.ns(), span.end.ns()};
    schedule_.Slice(world_row_, both, both, real);
  }
  void SentSensors(VirtualTime at) { schedule_.Instant(world_row_, "sensors", at.ns()); }

 private:
  [[nodiscard]] std::string OpenFiles();

  RunState& run_;
  World& world_;
  Activations& activations_;
  AnswerFeed* answers_ = nullptr;
  ScheduleRecords schedule_;
  ResponseLog responses_;
  OutputLog output_;
  MetricBook metrics_;
  ClientMetrics client_metrics_{metrics_, [this](const std::string& text) { run_.Warn(text); }};
  int world_row_ = 0;
};

}  // namespace tcs
