// Serial devices that channels are on. Internal to LoadScenario: mistakes are thrown as
// ScenarioMistake.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "coordinator/scenario/scenario.h"
#include "coordinator/scenario/yaml_reader.h"

namespace tcs {

// The devices so far. Any number of sensors are on a device, and at most one channel of commands;
// all of these say the same of the device's line.
class SerialPorts {
 public:
  // The keys that say which device a channel is on, and how the device's line is.
  static const std::vector<std::string>& Keys();

  SerialPort Load(const YamlMap& map, bool for_commands, const Scenario& scenario);

 private:
  struct Use {
    SerialPort port;
    std::string name;  // of the map
    Place place;
    bool for_commands;
  };
  std::vector<Use> uses_;
};

}  // namespace tcs
