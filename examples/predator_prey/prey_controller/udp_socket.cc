#include "examples/predator_prey/prey_controller/udp_socket.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <cerrno>
#include <system_error>

namespace predator_prey {
namespace {

constexpr std::size_t kMaxDatagramBytes = 65536;

std::system_error SystemError(const std::string& what) {
  return std::system_error(errno, std::generic_category(), what);
}

sockaddr_in AddressOf(const std::string& host, std::uint16_t port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  if (::inet_pton(AF_INET, host.c_str(), &address.sin_addr) != 1) {
    throw std::system_error(EINVAL, std::generic_category(), "no IPv4 address: " + host);
  }
  return address;
}

UniqueFd OpenUdp() {
  const int fd = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (fd < 0) throw SystemError("cannot open a UDP socket");
  return UniqueFd(fd);
}

}  // namespace

UdpSocket UdpSocket::BoundTo(const std::string& host, std::uint16_t port) {
  UdpSocket socket(OpenUdp());
  const sockaddr_in address = AddressOf(host, port);
  if (::bind(socket.fd(), reinterpret_cast<const sockaddr*>(&address), sizeof(address)) != 0) {
    throw SystemError("cannot receive on UDP port " + std::to_string(port));
  }
  return socket;
}

UdpSocket UdpSocket::ConnectedTo(const std::string& host, std::uint16_t port) {
  UdpSocket socket(OpenUdp());
  const sockaddr_in address = AddressOf(host, port);
  if (::connect(socket.fd(), reinterpret_cast<const sockaddr*>(&address), sizeof(address)) != 0) {
    throw SystemError("cannot send to UDP port " + std::to_string(port));
  }
  return socket;
}

std::optional<std::string> UdpSocket::ReceiveNewest() {
  std::optional<std::string> newest;
  std::string datagram(kMaxDatagramBytes, '\0');
  for (;;) {
    const ssize_t bytes = ::recv(fd(), datagram.data(), datagram.size(), MSG_DONTWAIT);
    if (bytes >= 0) {
      newest = datagram.substr(0, static_cast<std::size_t>(bytes));
    } else if (errno == EAGAIN || errno == EWOULDBLOCK) {
      return newest;
    } else if (errno != EINTR) {
      throw SystemError("cannot receive from a UDP socket");
    }
  }
}

void UdpSocket::Send(std::string_view datagram) {
  for (;;) {
    if (::send(fd(), datagram.data(), datagram.size(), 0) >= 0) return;
    // A connected socket reports here, once, that an earlier datagram found nobody.
    if (errno == EINTR) continue;
    if (errno == ECONNREFUSED || errno == EAGAIN || errno == ENOBUFS) return;
    throw SystemError("cannot send to a UDP socket");
  }
}

}  // namespace predator_prey
