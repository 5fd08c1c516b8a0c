// How a run is going, for people who watch, and what it reports at its end.
//
// For the coordinator's thread only; changes nothing but RunState::report.
#pragma once

#include <cstdint>

#include "coordinator/calls/datagram_queues.h"
#include "coordinator/calls/dds_records.h"
#include "coordinator/engine/pacing.h"
#include "coordinator/processes/launches.h"
#include "coordinator/processes/usage_book.h"
#include "coordinator/queues/futex_table.h"
#include "coordinator/tasks/activations.h"
#include "coordinator/tasks/answer_feed.h"
#include "coordinator/tasks/coordinator.h"
#include "coordinator/tasks/run_clock.h"
#include "coordinator/tasks/run_state.h"
#include "coordinator/world/world.h"

namespace tcs {

class RunReporter {
 public:
  // The objects that the reporter reads, which outlive it.
  struct Sources {
    const RunClock& clock;
    const World& world;
    const UsageBook& usage;
    const Launches& launches;
    const DdsRecords& dds_records;
    const Pacing& pacing;
    const Activations& activations;
    AnswerFeed& answers;
    DatagramQueues& datagrams;
    const FutexTable& futexes;
  };

  RunReporter(RunState& run, const Sources& from) : run_(run), from_(from) {}

  RunProgress Now() const;

  // The run is over, at `end`: reports its figures, and warns of what cannot have been meant. The
  // run does not include what clients do from now on.
  void Conclude(VirtualTime end);

 private:
  // The coordinator's own part of the processor time that the run has had.
  std::int64_t CoordinatingNs() const;
  ClientReport ReportOf(const Launches::Launch& launch) const;
  void Answer(VirtualTime end);
  void WarnOfNeverStarted();
  void WarnOfEndsThatDidNotMeet();

  RunState& run_;
  const Sources from_;
};

}  // namespace tcs
