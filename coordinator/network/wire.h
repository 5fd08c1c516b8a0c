// The packets between the robots: which way a packet goes, and when it arrives.
//
// Used by the coordinator's only thread. Pure: no system calls, no clock. Trusts nothing in
// packets.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <vector>

#include "coordinator/network/lost_segments.h"
#include "coordinator/network/network_link.h"
#include "coordinator/network/packet.h"
#include "coordinator/scenario/network_spec.h"
#include "shm/virtual_time.h"

namespace tcs {

class Wire {
 public:
  explicit Wire(const NetworkSpec& spec);

  // A robot sends an IPv4 packet, at that time. A packet to an address that no robot has goes
  // nowhere; broadcast and multicast go to all others, each over its own link.
  void Send(std::size_t robot, std::span<const std::byte> packet, VirtualTime at);

  VirtualTime NextDue() const;
  // Hands over the packets that have arrived by `now`, in order.
  using Receive = std::function<void(std::size_t robot, std::span<const std::byte> packet)>;
  void Arrive(VirtualTime now, const Receive& receive);

  // The link between two robots, also for messages that do not go in packets.
  NetworkLink& Between(std::size_t from, std::size_t to) { return links_[from * robots_ + to]; }
  const NetworkLink& Between(std::size_t from, std::size_t to) const {
    return links_[from * robots_ + to];
  }
  // How long a message and the answer to it take at the least.
  VirtualDuration RoundTrip(std::size_t from, std::size_t to) const {
    return Between(from, to).spec().latency + Between(to, from).spec().latency;
  }
  std::size_t robots() const { return robots_; }

 private:
  using Bytes = std::shared_ptr<const std::vector<std::byte>>;
  struct Packet {
    std::size_t to;
    Bytes bytes;
  };

  void SendTo(std::size_t from, std::size_t to, const PacketHead& head, const Bytes& bytes,
              VirtualTime at);
  void SendAgain(LostSegments::Segment segment, VirtualTime at);
  void Lose(LostSegments::Segment segment, VirtualTime at);
  bool HasBegunBefore(const TcpSegment& segment);

  std::size_t robots_;
  std::map<std::uint32_t, std::size_t> robot_at_;  // by address
  std::vector<NetworkLink> links_;                 // of every robot to every robot
  std::multimap<VirtualTime, Packet> on_the_way_;
  LostSegments lost_;
  std::map<TcpFlow, std::uint32_t> begun_;  // the sequence number of each flow's beginning
};

}  // namespace tcs
