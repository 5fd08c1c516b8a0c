// Why a run is not what was asked for: clients that failed, or a signal that stopped the run.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "coordinator/tasks/coordinator.h"

namespace tcs {

// True if the client ended before the run's end, and not as a program that has done its work.
bool HasFailed(const ClientReport& client);

// "rover/driver ended at 1.350 s with signal 11 (Segmentation fault)", of a client that did end.
std::string HowItEnded(const ClientReport& client);

// "rover/driver ended at 1.350 s with exit status 1: "its last line" (rover-driver.err.log)". Reads
// the client's logs in `folder`; `shown` is what stands before their names.
std::string FailureOf(const ClientReport& client, const std::string& folder,
                      const std::string& shown);

// A sentence for each client that failed, the first one first; then for the signal that stopped the
// run, which should have gone on until `end_ns`.
std::vector<std::string> FailuresIn(const RunReport& report, std::int64_t end_ns,
                                    const std::string& folder);

}  // namespace tcs
