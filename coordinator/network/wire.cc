#include "coordinator/network/wire.h"

#include <arpa/inet.h>
#include <netinet/in.h>

#include <algorithm>
#include <optional>
#include <utility>

namespace tcs {

namespace {

// As Linux has them: the least retransmission timeout beyond the round trip, and the first one of
// all, before there was a round trip.
constexpr VirtualDuration kLeastTimeout = VirtualDuration::Milliseconds(200);
constexpr VirtualDuration kFirstTimeout = VirtualDuration::Seconds(1);

constexpr std::uint32_t kHostsOfNet = 0xff;  // addresses that differ in these bits are one network

// Whether the packet is for all computers, or for those of a group.
bool IsForSeveral(const PacketHead& head) {
  const std::uint32_t net = head.from | kHostsOfNet;
  return head.to == INADDR_BROADCAST || head.to == net || IN_MULTICAST(head.to);
}

}  // namespace

Wire::Wire(const NetworkSpec& spec) : robots_(spec.addresses.size()) {
  for (std::size_t from = 0; from < robots_; ++from) {
    in_addr address{};
    inet_pton(AF_INET, spec.addresses[from].c_str(), &address);
    robot_at_[ntohl(address.s_addr)] = from;
    for (std::size_t to = 0; to < robots_; ++to) {
      links_.emplace_back(spec.Link(from, to), spec.seed, from * robots_ + to);
    }
  }
}

void Wire::Send(std::size_t robot, std::span<const std::byte> packet, VirtualTime at) {
  const std::optional<PacketHead> head = HeadOf(packet);
  // The membership of groups is no secret here, and the kernel tells of it when its timers run out.
  if (!head || head->protocol == IPPROTO_IGMP) return;
  if (head->tcp && head->tcp->is_syn && HasBegunBefore(*head->tcp)) return;
  const auto bytes = std::make_shared<const std::vector<std::byte>>(packet.begin(), packet.end());
  if (IsForSeveral(*head)) {
    for (std::size_t to = 0; to < robots_; ++to) {
      if (to != robot) SendTo(robot, to, *head, bytes, at);
    }
  } else if (const auto found = robot_at_.find(head->to);
             found != robot_at_.end() && found->second != robot) {
    SendTo(robot, found->second, *head, bytes, at);
  }
}

// The first segment of a connection is the one that the kernel's own timer, in the host's time, may
// send again: a second one means nothing, for a first segment that is lost arrives after its
// timeout.
bool Wire::HasBegunBefore(const TcpSegment& segment) {
  const auto [place, is_new] = begun_.try_emplace(segment.flow, segment.sequence);
  return !is_new && std::exchange(place->second, segment.sequence) == segment.sequence;
}

void Wire::SendTo(std::size_t from, std::size_t to, const PacketHead& head, const Bytes& bytes,
                  VirtualTime at) {
  if (const auto arrives = Between(from, to).Send(at, bytes->size())) {
    on_the_way_.emplace(*arrives, Packet{to, bytes});
    if (head.tcp) lost_.Passed(*head.tcp);
  } else if (head.tcp) {
    Lose({.head = *head.tcp, .packet = bytes, .from = from, .to = to}, at);
  }
}

void Wire::Lose(LostSegments::Segment segment, VirtualTime at) {
  const VirtualDuration first =
      segment.head.is_syn ? kFirstTimeout : RoundTrip(segment.from, segment.to) + kLeastTimeout;
  const VirtualDuration timeout = first * (std::int64_t{1} << std::min(segment.timeouts, 6));
  ++segment.timeouts;
  lost_.Lose(std::move(segment), at + timeout);
}

void Wire::SendAgain(LostSegments::Segment segment, VirtualTime at) {
  const auto arrives = Between(segment.from, segment.to).Send(at, segment.packet->size());
  if (!arrives) return Lose(std::move(segment), at);
  lost_.Passed(segment.head);
  on_the_way_.emplace(*arrives, Packet{segment.to, segment.packet});
}

VirtualTime Wire::NextDue() const {
  const VirtualTime packet =
      on_the_way_.empty() ? VirtualTime::Never() : on_the_way_.begin()->first;
  return std::min(packet, lost_.NextDue());
}

void Wire::Arrive(VirtualTime now, const Receive& receive) {
  while (NextDue() <= now) {
    if (const VirtualTime due = NextDue(); lost_.NextDue() == due) {
      if (auto segment = lost_.Take(due)) SendAgain(std::move(*segment), due);
      continue;
    }
    const Packet packet = std::move(on_the_way_.begin()->second);
    on_the_way_.erase(on_the_way_.begin());
    receive(packet.to, *packet.bytes);
  }
}

}  // namespace tcs
