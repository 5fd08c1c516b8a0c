// Arrows and instants of a trace: messages from their senders to their receivers, with their age at
// that time, and what clients wrote.
#pragma once

#include <string>

#include "coordinator/perfetto/event_writer.h"
#include "coordinator/perfetto/schedule.h"

namespace tcs::perfetto {

// Adds the messages of messages.csv (DDS) and datagrams.csv, as far as these are there. Empty on
// success, else one sentence. Of very many datagrams only the first are added.
[[nodiscard]] std::string AddMessages(const std::string& folder, const Schedule& schedule,
                                      EventWriter* events);
// Adds the lines of output.csv and the clients' logs. Of very long logs only the beginnings are
// added.
void AddOutput(const std::string& folder, const Schedule& schedule, EventWriter* events);

}  // namespace tcs::perfetto
