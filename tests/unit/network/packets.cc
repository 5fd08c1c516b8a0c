#include "tests/unit/network/packets.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/ip.h>
#include <netinet/tcp.h>

#include <cstring>

namespace tcs {

namespace {

PacketBytes Packet(const std::string& from, const std::string& to, std::uint8_t protocol,
                   std::size_t size) {
  iphdr head{};
  head.version = 4;
  head.ihl = 5;
  head.tot_len = htons(static_cast<std::uint16_t>(size));
  head.protocol = protocol;
  inet_pton(AF_INET, from.c_str(), &head.saddr);
  inet_pton(AF_INET, to.c_str(), &head.daddr);
  PacketBytes bytes(size);
  std::memcpy(bytes.data(), &head, sizeof head);
  return bytes;
}

}  // namespace

PacketBytes UdpPacket(const std::string& from, const std::string& to, std::size_t size) {
  return Packet(from, to, IPPROTO_UDP, size);
}

PacketBytes TcpPacket(const std::string& from, const std::string& to, const TcpFields& fields) {
  tcphdr tcp{};
  tcp.source = htons(40000);
  tcp.dest = htons(5000);
  tcp.seq = htonl(fields.sequence);
  tcp.ack_seq = htonl(fields.acknowledges);
  tcp.doff = 5;
  tcp.syn = fields.syn;
  tcp.fin = fields.fin;
  PacketBytes bytes = Packet(from, to, IPPROTO_TCP, sizeof(iphdr) + sizeof tcp + fields.payload);
  std::memcpy(bytes.data() + sizeof(iphdr), &tcp, sizeof tcp);
  return bytes;
}

}  // namespace tcs
