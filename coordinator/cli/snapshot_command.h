// `tcsim snapshot`, and what `tcsim run` does with --stop-at and --from.
#pragma once

#include <string>

#include "coordinator/scenario/scenario.h"
#include "shm/virtual_time.h"

namespace tcs {

struct SnapshotArguments {
  std::string from;  // DIR or DIR@TIME
  std::string out;   // empty: it is printed
};

// The exit status.
int SnapshotCommand(const SnapshotArguments& arguments);

// Why a run of the scenario cannot stop there with a snapshot: one sentence. Empty: it can.
std::string WhyNoStopAt(const Scenario& scenario, VirtualDuration duration,
                        VirtualDuration stop_at);
// Writes snapshot.yaml into the folder of a run that has stopped. Empty on success, else one
// sentence.
[[nodiscard]] std::string WriteSnapshot(const std::string& folder);

// What there is to say to who asks for a run from within another one.
std::string NoWayBack(const std::string& from);

}  // namespace tcs
