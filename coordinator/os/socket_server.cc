#include "coordinator/os/socket_server.h"

#include <errno.h>
#include <linux/inet_diag.h>
#include <linux/netlink.h>
#include <linux/sock_diag.h>
#include <netinet/in.h>

#include <cstring>

#include "coordinator/port/unique_fd.h"

namespace tcs {

namespace {

// Address and port are in the order of the network, as sock_diag has them.
struct Place {
  std::uint32_t address[4] = {};
  std::uint16_t port = 0;
  bool is_mapped = false;  // an IPv4 address that IPv6 was given
};

Place PlaceOf(const sockaddr_storage& address) {
  Place place;
  if (address.ss_family == AF_INET) {
    sockaddr_in four;
    memcpy(&four, &address, sizeof four);
    memcpy(place.address, &four.sin_addr, sizeof four.sin_addr);
    place.port = four.sin_port;
  } else {
    sockaddr_in6 six;
    memcpy(&six, &address, sizeof six);
    place.is_mapped = IN6_IS_ADDR_V4MAPPED(&six.sin6_addr);
    const unsigned char* bytes = six.sin6_addr.s6_addr;
    if (place.is_mapped) {
      memcpy(place.address, bytes + 12, 4);
    } else {
      memcpy(place.address, bytes, sizeof six.sin6_addr);
    }
    place.port = six.sin6_port;
  }
  return place;
}

struct Request {
  nlmsghdr head;
  inet_diag_req_v2 body;
};

Request RequestFor(int family, int protocol) {
  Request request{};
  request.head.nlmsg_len = sizeof request;
  request.head.nlmsg_type = SOCK_DIAG_BY_FAMILY;
  request.head.nlmsg_flags = NLM_F_REQUEST;
  request.body.sdiag_family = static_cast<__u8>(family);
  request.body.sdiag_protocol = static_cast<__u8>(protocol);
  request.body.idiag_states = ~0U;
  request.body.id.idiag_cookie[0] = request.body.id.idiag_cookie[1] = INET_DIAG_NOCOOKIE;
  return request;
}

std::optional<std::uint64_t> Ask(const Request& request) {
  const UniqueFd link(socket(AF_NETLINK, SOCK_RAW | SOCK_CLOEXEC, NETLINK_SOCK_DIAG));
  alignas(nlmsghdr) char answer[4096];
  if (!link || send(link.get(), &request, sizeof request, 0) < 0) return std::nullopt;
  const ssize_t size = recv(link.get(), answer, sizeof answer, 0);
  nlmsghdr head;
  if (size < static_cast<ssize_t>(sizeof head)) return std::nullopt;
  memcpy(&head, answer, sizeof head);
  if (head.nlmsg_type == NLMSG_ERROR) {
    nlmsgerr error;
    if (size < static_cast<ssize_t>(NLMSG_LENGTH(sizeof error))) return std::nullopt;
    memcpy(&error, answer + NLMSG_HDRLEN, sizeof error);
    return error.error == -ENOENT ? std::optional<std::uint64_t>(0) : std::nullopt;
  }
  inet_diag_msg found;
  if (size < static_cast<ssize_t>(NLMSG_LENGTH(sizeof found))) return std::nullopt;
  memcpy(&found, answer + NLMSG_HDRLEN, sizeof found);
  return found.idiag_inode;
}

}  // namespace

// For TCP the place of the server is the source. For UDP server and client are the other way round,
// and the server may be connected to the socket that sends.
std::optional<std::uint64_t> ServerOf(int fd, const sockaddr_storage& peer) {
  int type = 0;
  socklen_t size = sizeof type;
  sockaddr_storage own{};
  socklen_t own_size = sizeof own;
  if (getsockopt(fd, SOL_SOCKET, SO_TYPE, &type, &size) != 0 ||
      getsockname(fd, reinterpret_cast<sockaddr*>(&own), &own_size) != 0) {
    return std::nullopt;
  }
  const bool is_tcp = type == SOCK_STREAM;
  const Place server = PlaceOf(peer), client = PlaceOf(own);
  const int family = server.is_mapped ? AF_INET : peer.ss_family;
  Request request = RequestFor(family, is_tcp ? IPPROTO_TCP : IPPROTO_UDP);
  inet_diag_sockid& id = request.body.id;
  memcpy(is_tcp ? id.idiag_src : id.idiag_dst, server.address, sizeof server.address);
  (is_tcp ? id.idiag_sport : id.idiag_dport) = server.port;
  if (!is_tcp) {
    memcpy(id.idiag_src, client.address, sizeof client.address);
    id.idiag_sport = client.port;
  }
  return Ask(request);
}

}  // namespace tcs
