// Sensors of robots that are models: channels whose `sensors` have a `kind`. Internal to
// LoadScenario: mistakes are thrown as ScenarioMistake.
#pragma once

#include <string>
#include <vector>

#include "coordinator/scenario/scenario.h"
#include "coordinator/scenario/yaml_reader.h"

namespace tcs {

// The link that `value` names, MODEL/LINK, or MODEL, which is the model's root; the link's own name
// in `name`.
int LoadLink(const YamlValue& value, const Scenario& scenario, std::string* name);

// Whether the channel with the keys of `map` is about such a sensor.
bool IsAboutInstrument(const YamlMap& map);

// The keys of the kind in `map`, without the keys of the transport.
std::vector<std::string> InstrumentKeys(const YamlMap& map);

// Loads the sensor, and the errors of what it measures, into `channel`, whose period is known; for
// a sensor that has something to say only once, the period becomes 0.
void LoadInstrument(const YamlMap& map, const Scenario& scenario, SensorChannelSpec* channel);

// For channels of JSON in datagrams: not all kinds fit.
void CheckFitsDatagram(const YamlMap& map, const InstrumentSpec& spec);

// The message that tells of the sensor on DDS, and its topic where nothing else is said: the topic
// may have no name.
dds::SensorMessage MessageOf(const YamlMap& map);
DdsTopicSpec DefaultEndOf(const YamlMap& map);

}  // namespace tcs
