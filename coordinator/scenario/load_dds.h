// The parts of a scenario file that stand on DDS: channels of the type `dds`, and `clock`. Internal
// to LoadScenario: mistakes are thrown as ScenarioMistake.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "coordinator/scenario/scenario.h"
#include "coordinator/scenario/yaml_reader.h"

namespace tcs {

// The topics that are used so far: in one domain a topic carries one type.
class DdsTopics {
 public:
  // The topic's name, for samples of the type `message`.
  std::string Load(const YamlValue& value, int domain, std::string_view message);
  void Add(const YamlValue& value, const std::string& topic, int domain, std::string_view message);

 private:
  struct Use {
    std::string topic;
    int domain;
    std::string message;
    std::string name;
    Place place;
  };
  std::vector<Use> uses_;
};

// `sensor` has what the channel says besides.
DdsSensorEnd LoadDdsSensorEnd(const YamlMap& map, const SensorChannelSpec& sensor,
                              DdsTopics* topics);
DdsCommandEnd LoadDdsCommandEnd(const YamlMap& map, const CommandChannelSpec& command,
                                DdsTopics* topics);
ClockSpec LoadClock(const YamlValue& value, DdsTopics* topics);

dds::RosRelease LoadRosRelease(const YamlValue& value);

// Once all else is loaded: a warning for each client that uses sockets on a host of its robot's
// own, where the scenario's topics are not served (gateway/gateway_robot.h).
void CheckDdsTransports(const YamlMap& top, Scenario* scenario);

}  // namespace tcs
