// Where channels on sockets send, and where they listen. Internal to LoadScenario: mistakes are
// thrown as ScenarioMistake.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "coordinator/scenario/scenario.h"
#include "coordinator/scenario/substitute.h"
#include "coordinator/scenario/yaml_reader.h"

namespace tcs {

// The endpoints given so far: each belongs to one channel.
class UdpEndpoints {
 public:
  UdpEndpoint Load(const YamlValue& value);
  // One that can be sent to.
  UdpEndpoint LoadReceiver(const YamlValue& value);

 private:
  struct Use {
    UdpEndpoint endpoint;
    std::string name;
    Place place;
  };
  std::vector<Use> uses_;
};

// The same of UNIX sockets' names.
class UnixNames {
 public:
  explicit UnixNames(Variables variables) : variables_(std::move(variables)) {}

  UnixName Load(const YamlValue& value);

 private:
  struct Use {
    std::string text;
    std::string name;
    Place place;
  };
  Variables variables_;
  std::vector<Use> uses_;
};

}  // namespace tcs
