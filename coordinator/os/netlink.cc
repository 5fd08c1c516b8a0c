#include "coordinator/os/netlink.h"

#include <errno.h>
#include <linux/netlink.h>
#include <linux/pkt_sched.h>
#include <linux/rtnetlink.h>
#include <sys/socket.h>

#include <cstddef>
#include <cstring>

namespace tcs {

namespace {

// A message with its attributes behind it.
template <class Body>
class Message {
 public:
  explicit Message(std::uint16_t type) {
    head_.nlmsg_len = NLMSG_LENGTH(sizeof(Body));
    head_.nlmsg_type = type;
    head_.nlmsg_flags = NLM_F_REQUEST | NLM_F_ACK | NLM_F_CREATE | NLM_F_REPLACE;
  }

  Body& body() { return body_; }
  std::uint32_t size() const { return head_.nlmsg_len; }
  const void* data() const { return this; }

  void Add(std::uint16_t type, const void* value, std::size_t size) {
    rtattr attribute{static_cast<unsigned short>(RTA_LENGTH(size)), type};
    char* at = attributes_ + used_;
    memcpy(at, &attribute, sizeof attribute);
    if (size > 0) memcpy(at + RTA_LENGTH(0), value, size);
    Grow(RTA_SPACE(size));
  }
  template <class Value>
  void Add(std::uint16_t type, const Value& value) {
    Add(type, &value, sizeof value);
  }
  // Attributes that are added until End are inside.
  std::size_t Begin(std::uint16_t type) {
    const std::size_t begun = used_;
    Add(type, nullptr, 0);
    return begun;
  }
  void End(std::size_t begun) {
    const auto size = static_cast<unsigned short>(used_ - begun);
    memcpy(attributes_ + begun, &size, sizeof size);
  }

 private:
  void Grow(std::size_t bytes) {
    used_ += bytes;
    head_.nlmsg_len = static_cast<std::uint32_t>(NLMSG_LENGTH(sizeof(Body)) + used_);
  }

  nlmsghdr head_{};
  Body body_{};
  alignas(NLMSG_ALIGNTO) char attributes_[256] = {};
  std::size_t used_ = 0;
};

// A route to the first `bits` of `to`, which is on the device's own link. Packets leave from
// `source` where their program has not bound an address.
Message<rtmsg> RouteOnLink(int device, unsigned char type, unsigned char table, in_addr to,
                           unsigned bits, in_addr source) {
  Message<rtmsg> message(RTM_NEWROUTE);
  message.body().rtm_family = AF_INET;
  message.body().rtm_dst_len = static_cast<unsigned char>(bits);
  message.body().rtm_table = table;
  message.body().rtm_protocol = RTPROT_STATIC;
  message.body().rtm_scope = RT_SCOPE_LINK;
  message.body().rtm_type = type;
  message.Add(RTA_DST, to);
  message.Add(RTA_PREFSRC, source);
  message.Add(RTA_OIF, device);
  return message;
}

}  // namespace

Netlink::Netlink() : socket_(socket(AF_NETLINK, SOCK_RAW | SOCK_CLOEXEC, NETLINK_ROUTE)) {}

int Netlink::Do(const void* message, std::uint32_t size) {
  struct {
    nlmsghdr head;
    nlmsgerr error;
    char rest[512];
  } answer{};
  if (send(socket_.get(), message, size, 0) != static_cast<ssize_t>(size)) return errno;
  if (recv(socket_.get(), &answer, sizeof answer, 0) < 0) return errno;
  return answer.head.nlmsg_type == NLMSG_ERROR ? -answer.error.error : EPROTO;
}

int Netlink::Set(int device, std::uint16_t what, std::uint32_t value) {
  Message<ifinfomsg> message(RTM_SETLINK);
  message.body().ifi_family = AF_UNSPEC;
  message.body().ifi_index = device;
  message.Add(what, value);
  return Do(message.data(), message.size());
}

int Netlink::KeepPackets(int device, std::uint32_t packets) {
  return Set(device, IFLA_TXQLEN, packets);
}

int Netlink::SendSegmentsOneByOne(int device) { return Set(device, IFLA_GSO_MAX_SEGS, 1); }

int Netlink::AddAddress(int device, in_addr address) {
  Message<ifaddrmsg> message(RTM_NEWADDR);
  message.body().ifa_family = AF_INET;
  message.body().ifa_prefixlen = 32;
  message.body().ifa_index = static_cast<unsigned>(device);
  message.Add(IFA_LOCAL, address);
  message.Add(IFA_ADDRESS, address);
  return Do(message.data(), message.size());
}

int Netlink::AddRoute(int device, in_addr to, unsigned bits, in_addr source,
                      const RouteMetrics& metrics) {
  auto message = RouteOnLink(device, RTN_UNICAST, RT_TABLE_MAIN, to, bits, source);
  const std::size_t begun = message.Begin(RTA_METRICS);
  if (metrics.least_timeout_ms != 0) message.Add(RTAX_RTO_MIN, metrics.least_timeout_ms);
  if (metrics.acknowledges_at_once) message.Add(RTAX_QUICKACK, std::uint32_t{1});
  message.End(begun);
  return Do(message.data(), message.size());
}

int Netlink::AddBroadcast(int device, in_addr to, in_addr source) {
  const auto message = RouteOnLink(device, RTN_BROADCAST, RT_TABLE_LOCAL, to, 32, source);
  return Do(message.data(), message.size());
}

int Netlink::SendWithoutQueue(int device) {
  Message<tcmsg> message(RTM_NEWQDISC);
  message.body().tcm_family = AF_UNSPEC;
  message.body().tcm_ifindex = device;
  message.body().tcm_parent = TC_H_ROOT;
  constexpr char kKind[] = "noqueue";
  message.Add(TCA_KIND, kKind, sizeof kKind);
  return Do(message.data(), message.size());
}

}  // namespace tcs
