// An observer that is told of each datagram that goes over a channel, to say later which program
// had the datagram.
#pragma once

#include <cstddef>
#include <string>

#include "coordinator/channel/channel.h"
#include "shm/own_receivers.h"

namespace tcs {

class DatagramWatch {
 public:
  // A reading of that channel is in the socket with the address.
  virtual void WorldSent(const std::string& channel, const shm::ReceiverAddress& to,
                         VirtualTime at) = 0;
  // A command has come in; channels of commands are numbered as in the scenario.
  virtual void WorldReceived(std::size_t channel, const CommandSent& sent) = 0;

 protected:
  ~DatagramWatch() = default;
};

}  // namespace tcs
