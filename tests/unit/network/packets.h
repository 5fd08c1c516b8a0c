// IPv4 packets as a robot's kernel sends them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "coordinator/network/packet.h"

namespace tcs {

using PacketBytes = std::vector<std::byte>;

// Its head and so many zeros; the whole packet is `size` bytes, at least a head.
PacketBytes UdpPacket(const std::string& from, const std::string& to, std::size_t size = 128);

struct TcpFields {
  std::uint32_t sequence = 0, acknowledges = 0;
  bool syn = false, fin = false;
  std::size_t payload = 0;
};
// From port 40000 to port 5000.
PacketBytes TcpPacket(const std::string& from, const std::string& to, const TcpFields& fields);

}  // namespace tcs
