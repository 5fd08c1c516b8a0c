// The network of a run: a computer of its own for each robot (os/own_computer.h), and the wire
// between them.
//
// For the coordinator's thread only. The caller of a step says the time. A packet is sent at the
// virtual time of the thread that sent it, and received when no leaf can act before that time any
// more.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "coordinator/network/wire.h"
#include "coordinator/os/own_computer.h"
#include "coordinator/scenario/scenario.h"
#include "shm/virtual_time.h"

namespace tcs {

class RobotNetwork {
 public:
  // Makes the computers, if the scenario has a network. Empty on success, else one sentence.
  [[nodiscard]] std::string Open(const Scenario& scenario);
  bool present() const { return wire_.has_value(); }

  // The descriptor of each robot, in the scenario's order: readable once the robot has sent
  // something.
  std::vector<int> fds() const;
  // Takes the packets that the robot has sent, all of them at that time.
  void Take(std::size_t robot, VirtualTime at);

  VirtualTime NextDue() const { return present() ? wire_->NextDue() : VirtualTime::Never(); }
  // Delivers the packets that have arrived by then.
  void Arrive(VirtualTime now);

  // Null without a network.
  const OwnComputer* ComputerOf(std::size_t robot) const {
    return present() ? &computers_[robot] : nullptr;
  }
  // Has a socket made where programs reach that address.
  void MakeAt(const std::string& address, const std::function<void()>& make) const;

  // Writes network.csv in that folder: the packets that each link was given to carry, and those
  // that did not arrive. Empty on success, else one sentence.
  [[nodiscard]] std::string WriteCounts(const std::string& folder) const;

  // Null without a network.
  Wire* wire() { return wire_ ? &*wire_ : nullptr; }

 private:
  std::optional<Wire> wire_;
  std::vector<std::string> names_, addresses_;  // of the robots
  std::vector<OwnComputer> computers_;
};

}  // namespace tcs
