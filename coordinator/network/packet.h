// The parts of an IPv4 packet that the network reads. Trusts nothing in the packet.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <tuple>

namespace tcs {

// A direction of a TCP connection.
struct TcpFlow {
  std::uint32_t from = 0, to = 0;  // addresses, in the host's byte order
  std::uint16_t from_port = 0, to_port = 0;

  auto operator<=>(const TcpFlow&) const = default;
};

struct TcpSegment {
  TcpFlow flow;
  std::uint32_t sequence = 0, acknowledges = 0;
  std::uint32_t length = 0;  // of all that has sequence numbers: bytes, SYN and FIN
  bool is_syn = false, is_reset = false;

  std::uint32_t end() const { return sequence + length; }
};

struct PacketHead {
  std::uint32_t from = 0, to = 0;  // addresses, in the host's byte order
  std::uint8_t protocol = 0;       // IPPROTO_*
  std::optional<TcpSegment> tcp;   // of a whole segment
};

// Nothing: `packet` is no IPv4 packet.
std::optional<PacketHead> HeadOf(std::span<const std::byte> packet);

}  // namespace tcs
