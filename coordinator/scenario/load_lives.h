// When clients begin and how they end, and where they work. Internal to LoadScenario: mistakes are
// thrown as ScenarioMistake.
#pragma once

#include "coordinator/scenario/scenario.h"
#include "coordinator/scenario/substitute.h"
#include "coordinator/scenario/yaml_reader.h"

namespace tcs {

// `start`, `stop_signal`, `stop_grace` and `working_directory` of a client.
void LoadLife(const YamlMap& map, const Variables& variables, ClientSpec* client);

// Loads `after` of all clients, which may name each other. Clients that can never start are a
// warning, or in a cycle a mistake.
void LoadOrder(const YamlMap& robots, Scenario* scenario);

}  // namespace tcs
