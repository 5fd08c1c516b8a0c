#include "examples/predator_prey/common/udp_socket.h"

#include <sys/socket.h>

#include <cerrno>
#include <system_error>

namespace predator_prey {
namespace {

constexpr std::size_t kMaxDatagramBytes = 65536;

std::system_error SystemError(const std::string& what) {
  return std::system_error(errno, std::generic_category(), what);
}

sockaddr_in Loopback(std::uint16_t port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  return address;
}

UniqueFd OpenUdp() {
  const int fd = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (fd < 0) throw SystemError("cannot open a UDP socket");
  return UniqueFd(fd);
}

}  // namespace

UdpSocket UdpSocket::BoundTo(std::uint16_t port) {
  UdpSocket socket(OpenUdp());
  const sockaddr_in address = Loopback(port);
  if (::bind(socket.fd(), reinterpret_cast<const sockaddr*>(&address), sizeof(address)) != 0) {
    throw SystemError("cannot receive on UDP port " + std::to_string(port));
  }
  return socket;
}

UdpSocket UdpSocket::ConnectedTo(std::uint16_t port) {
  UdpSocket socket(OpenUdp());
  const sockaddr_in address = Loopback(port);
  if (::connect(socket.fd(), reinterpret_cast<const sockaddr*>(&address), sizeof(address)) != 0) {
    throw SystemError("cannot send to UDP port " + std::to_string(port));
  }
  socket.connected_ = true;
  return socket;
}

UdpSocket::Status UdpSocket::Receive(std::string& datagram) {
  datagram.resize(kMaxDatagramBytes);
  for (;;) {
    socklen_t address_bytes = sizeof(last_sender_);
    const ssize_t bytes = ::recvfrom(fd(), datagram.data(), datagram.size(), MSG_DONTWAIT,
                                     reinterpret_cast<sockaddr*>(&last_sender_), &address_bytes);
    if (bytes >= 0) {
      datagram.resize(static_cast<std::size_t>(bytes));
      return Status::kDatagram;
    }
    if (errno == EINTR) continue;
    datagram.clear();
    if (errno == EAGAIN || errno == EWOULDBLOCK) return Status::kNothing;
    if (errno == ECONNREFUSED) return Status::kPeerAbsent;
    throw SystemError("cannot receive from a UDP socket");
  }
}

std::optional<std::string> UdpSocket::ReceiveNewest() {
  std::optional<std::string> newest;
  std::string datagram;
  for (;;) {
    switch (Receive(datagram)) {
      case Status::kDatagram:
        newest = std::move(datagram);
        break;
      case Status::kNothing:
        return newest;
      case Status::kPeerAbsent:
        break;
    }
  }
}

void UdpSocket::Send(std::string_view datagram) {
  const auto* address = connected_ ? nullptr : reinterpret_cast<const sockaddr*>(&last_sender_);
  const socklen_t address_bytes = connected_ ? 0 : sizeof(last_sender_);
  for (;;) {
    if (::sendto(fd(), datagram.data(), datagram.size(), 0, address, address_bytes) >= 0) return;
    // A connected socket reports here, once, that an earlier datagram found nobody.
    if (errno == EINTR) continue;
    if (errno == ECONNREFUSED || errno == EAGAIN || errno == ENOBUFS) return;
    throw SystemError("cannot send to a UDP socket");
  }
}

}  // namespace predator_prey
