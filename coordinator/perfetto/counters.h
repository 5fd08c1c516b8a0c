// Counters of a trace, from the tables that a run has written. A table that is not there gives
// none.
#pragma once

#include <string>

#include "coordinator/perfetto/event_writer.h"

namespace tcs::perfetto {

// Each function returns an empty text on success, else one sentence.

// bodies.csv: where each body and link is, how it is turned, how fast it moves.
[[nodiscard]] std::string AddBodies(const std::string& folder, EventWriter* events);
// joints.csv.
[[nodiscard]] std::string AddJoints(const std::string& folder, EventWriter* events);
// sensors.csv: the values that sensors measured. Of a quantity with very many values only every
// second, third, … one is taken, as many as are not too many.
[[nodiscard]] std::string AddMeasurements(const std::string& folder, EventWriter* events);
// commands.csv: the commands, from when they act.
[[nodiscard]] std::string AddCommands(const std::string& folder, EventWriter* events);

}  // namespace tcs::perfetto
