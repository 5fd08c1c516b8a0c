// The settings that a network device gets by rtnetlink: address, routes, queue. A setting is one
// message, answered at once.
#pragma once

#include <netinet/in.h>

#include <cstdint>

#include "coordinator/port/unique_fd.h"

namespace tcs {

class Netlink {
 public:
  // Opens a socket in the network that the calling thread is in.
  Netlink();

  explicit operator bool() const { return static_cast<bool>(socket_); }

  // The functions below return 0 or the kernel's errno; `device` is the interface's index.

  // How many packets the device keeps for the process that reads them.
  int KeepPackets(int device, std::uint32_t packets);

  // TCP hands the device one segment at a time: otherwise their number would go by the round trip
  // in the host's time.
  int SendSegmentsOneByOne(int device);

  // Adds the device's own address, without a route.
  int AddAddress(int device, in_addr address);

  // How TCP behaves along a route; 0: as anywhere.
  struct RouteMetrics {
    std::uint32_t least_timeout_ms = 0;  // until TCP sends again
    bool acknowledges_at_once = false;
  };
  // A route to the addresses that begin with those bits, with `source` as the sender's.
  int AddRoute(int device, in_addr to, unsigned bits, in_addr source, const RouteMetrics& metrics);

  // Packets to that address are for all computers that can be reached over the device.
  int AddBroadcast(int device, in_addr to, in_addr source);

  // Packets are handed to the device at once when they are sent.
  int SendWithoutQueue(int device);

 private:
  int Set(int device, std::uint16_t what, std::uint32_t value);
  int Do(const void* message, std::uint32_t size);

  UniqueFd socket_;
};

}  // namespace tcs
