// The sections of a scenario file. Internal to LoadScenario: mistakes are thrown as
// ScenarioMistake.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "coordinator/scenario/scenario.h"
#include "coordinator/scenario/substitute.h"
#include "coordinator/scenario/yaml_reader.h"

namespace tcs {

// `dynamics`, `bodies` and `models`, into scenario->world.
void LoadWorld(const YamlMap& top, const Variables& variables, Scenario* scenario);

// `models`, into scenario->world, which has its bodies and its engine.
void LoadModels(const YamlValue& value, const Variables& variables, Scenario* scenario);

// `robots`. Reads the duration and the world's bodies from `scenario`.
void LoadRobots(const YamlMap& top, const Variables& variables, Scenario* scenario);
// `robots` itself; a scenario without one is refused, also where all mistakes are asked for.
const YamlValue& RobotsOf(const YamlMap& top);

// `network`, and the robots' addresses. Reads the robots and the seed from `scenario`.
void LoadNetwork(const YamlMap& top, Scenario* scenario);

// `channels` and `clock`. Reads the world's bodies from `scenario`.
void LoadChannels(const YamlMap& top, const Variables& variables, Scenario* scenario);

// `chains`. Reads the robots and the channels from `scenario`.
void LoadChains(const YamlMap& top, Scenario* scenario);
// `metrics`. Reads the world and the channels from `scenario`.
void LoadMetrics(const YamlMap& top, Scenario* scenario);
// `expect`. Reads all that the other sections have loaded from `scenario`. `is_shortened`: the run
// ends before its file's `duration`; see LeaveOutLater.
void LoadExpect(const YamlMap& top, bool is_shortened, Scenario* scenario);

// The seed of the part with this name, made from the scenario's seed: each part has random numbers
// of its own.
std::uint64_t SeedOf(std::uint64_t seed, std::string_view name);

// The index of the body that `value` names.
int FindBody(const YamlValue& value, const Scenario& scenario);

// The indices of the bodies that the list `value` names, each once.
std::vector<int> FindBodies(const YamlValue& value, const Scenario& scenario);

// The period of a rate in Hz, which is one over the rate.
VirtualDuration LoadPeriod(const YamlValue& value);

}  // namespace tcs
