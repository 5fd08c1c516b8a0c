// The sentences of `tcsim run` about --stop-at and --from.
#pragma once

#include <string>
#include <utility>

#include "coordinator/scenario/scenario.h"
#include "shm/virtual_time.h"

namespace tcs {

// "DIR@12.5s"; the folder may have an @, too.
std::pair<std::string, std::string> FolderAndTime(const std::string& from);

// Why a run of the scenario cannot stop there with a snapshot: one sentence. Empty: the run can
// stop there.
std::string WhyNoStopAt(const Scenario& scenario, VirtualDuration duration,
                        VirtualDuration stop_at);

// The sentence for a user who asks for a run that begins at a moment of another run.
std::string NoWayBack(const std::string& from);

}  // namespace tcs
