#include "coordinator/network/packet.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/ip.h>
#include <netinet/tcp.h>

#include <cstring>

namespace tcs {

namespace {

constexpr unsigned kVersion = 4;
constexpr std::size_t kWord = 4;  // the unit of heads' lengths, in bytes

template <class Head>
std::optional<Head> Read(std::span<const std::byte> bytes) {
  Head head;
  if (bytes.size() < sizeof head) return std::nullopt;
  std::memcpy(&head, bytes.data(), sizeof head);
  return head;
}

std::optional<TcpSegment> SegmentOf(const iphdr& ip, std::span<const std::byte> payload) {
  const auto tcp = Read<tcphdr>(payload);
  if (!tcp || payload.size() < tcp->doff * kWord) return std::nullopt;
  TcpSegment segment;
  segment.flow = {ntohl(ip.saddr), ntohl(ip.daddr), ntohs(tcp->source), ntohs(tcp->dest)};
  segment.sequence = ntohl(tcp->seq);
  segment.acknowledges = ntohl(tcp->ack_seq);
  segment.length =
      static_cast<std::uint32_t>(payload.size() - tcp->doff * kWord) + tcp->syn + tcp->fin;
  segment.is_syn = tcp->syn != 0;
  segment.is_reset = tcp->rst != 0;
  return segment;
}

}  // namespace

std::optional<PacketHead> HeadOf(std::span<const std::byte> packet) {
  const auto ip = Read<iphdr>(packet);
  if (!ip || ip->version != kVersion || ip->ihl * kWord < sizeof *ip) return std::nullopt;
  const std::size_t size = ntohs(ip->tot_len), head_size = ip->ihl * kWord;
  if (size > packet.size() || head_size > size) return std::nullopt;
  PacketHead head;
  head.from = ntohl(ip->saddr);
  head.to = ntohl(ip->daddr);
  head.protocol = ip->protocol;
  const bool is_fragment = (ntohs(ip->frag_off) & (IP_MF | IP_OFFMASK)) != 0;
  if (ip->protocol == IPPROTO_TCP && !is_fragment) {
    head.tcp = SegmentOf(*ip, packet.first(size).subspan(head_size));
  }
  return head;
}

}  // namespace tcs
