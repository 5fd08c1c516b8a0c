// Arrows and instants of a trace: messages from who sent them to who received them, and how old
// they were then; what clients wrote.
#pragma once

#include <string>

#include "coordinator/perfetto/event_writer.h"
#include "coordinator/perfetto/schedule.h"

namespace tcs::perfetto {

// Of messages.csv (DDS) and datagrams.csv, as far as they are there. Empty on success, else one
// sentence. Of very many datagrams the first.
[[nodiscard]] std::string AddMessages(const std::string& folder, const Schedule& schedule,
                                      EventWriter* events);
// Of output.csv and the clients' logs. Of very long logs their beginnings.
void AddOutput(const std::string& folder, const Schedule& schedule, EventWriter* events);

}  // namespace tcs::perfetto
