// Where channels on sockets send, and where they listen. Internal to LoadScenario: mistakes are
// thrown as ScenarioMistake.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "coordinator/scenario/scenario.h"
#include "coordinator/scenario/substitute.h"
#include "coordinator/scenario/yaml_reader.h"

namespace tcs {

// The endpoints given so far: each endpoint belongs to one channel.
class UdpEndpoints {
 public:
  // With a network each endpoint is at the address of a robot. `network` outlives this.
  UdpEndpoints(Variables variables, const std::optional<NetworkSpec>& network)
      : variables_(std::move(variables)), network_(network) {}

  UdpEndpoint Load(const YamlValue& value);
  // An address to which datagrams can be sent.
  UdpEndpoint LoadReceiver(const YamlValue& value);

 private:
  struct Use {
    UdpEndpoint endpoint;
    std::string name;
    Place place;
  };
  UdpEndpoint LoadEndpoint(const YamlValue& value) const;

  Variables variables_;
  const std::optional<NetworkSpec>& network_;
  std::vector<Use> uses_;
};

// The names of UNIX sockets given so far: each name belongs to one channel.
class UnixNames {
 public:
  // With a network, names without a file are each robot's own.
  UnixNames(Variables variables, bool has_network)
      : variables_(std::move(variables)), has_network_(has_network) {}

  UnixName Load(const YamlValue& value);

 private:
  struct Use {
    std::string text;
    std::string name;
    Place place;
  };
  Variables variables_;
  bool has_network_;
  std::vector<Use> uses_;
};

}  // namespace tcs
