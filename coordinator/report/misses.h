// Deadlines that were missed, as a timeline marks them.
#pragma once

#include "coordinator/explain/told.h"
#include "coordinator/report/timeline.h"

namespace tcs::report {

// In the order of their deadlines. The later ones of very many go without sentence and parts.
void AddMisses(const explain::Told& told, Timeline* timeline);

}  // namespace tcs::report
