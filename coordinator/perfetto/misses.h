// Deadlines that clients missed, in a trace.
#pragma once

#include <string>

#include "coordinator/perfetto/event_writer.h"
#include "coordinator/perfetto/schedule.h"

namespace tcs::perfetto {

// Adds an instant for each miss, on the row of the thread at the time when it should have been
// done, with the sentence that `tcsim explain` says. Without responses.csv or a summary there are
// none.
void AddMisses(const std::string& folder, const Schedule& schedule, EventWriter* events);

}  // namespace tcs::perfetto
