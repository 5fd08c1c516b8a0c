// Deadlines that were missed, as a timeline marks them.
#pragma once

#include "coordinator/explain/told.h"
#include "coordinator/report/timeline.h"

namespace tcs::report {

// Adds the misses in the order of their deadlines. Of very many misses the later ones go without
// sentence and parts.
void AddMisses(const explain::Told& told, Timeline* timeline);

}  // namespace tcs::report
