// Counters of a trace, from the tables that a run has written. Tables that are not there have none.
#pragma once

#include <string>

#include "coordinator/perfetto/event_writer.h"

namespace tcs::perfetto {

// Each is empty on success, else one sentence.

// bodies.csv: where each body and link is, how it is turned, how fast it moves.
[[nodiscard]] std::string AddBodies(const std::string& folder, EventWriter* events);
// joints.csv.
[[nodiscard]] std::string AddJoints(const std::string& folder, EventWriter* events);
// sensors.csv: what sensors measured. Of a quantity with very many values as many as every second,
// third, … gives that are not too many.
[[nodiscard]] std::string AddMeasurements(const std::string& folder, EventWriter* events);
// commands.csv: what acts, from when it does.
[[nodiscard]] std::string AddCommands(const std::string& folder, EventWriter* events);

}  // namespace tcs::perfetto
