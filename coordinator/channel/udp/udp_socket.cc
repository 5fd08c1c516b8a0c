#include "coordinator/channel/udp/udp_socket.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>
#include <string>
#include <utility>

namespace tcs {
namespace {

// No UDP datagram over IPv4 is longer.
constexpr std::size_t kLargestPayload = 65507;

std::optional<sockaddr_in> ToAddress(const UdpEndpoint& endpoint) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(endpoint.port);
  if (inet_pton(AF_INET, endpoint.host.c_str(), &address.sin_addr) != 1) return std::nullopt;
  return address;
}

UdpEndpoint FromAddress(const sockaddr_in& address) {
  std::array<char, INET_ADDRSTRLEN> host{};
  inet_ntop(AF_INET, &address.sin_addr, host.data(), host.size());
  return {host.data(), ntohs(address.sin_port)};
}

SocketError NotAnAddress(const UdpEndpoint& endpoint) {
  return {"'" + endpoint.host + "' is not an IPv4 address; write one like 127.0.0.1", EINVAL};
}

SocketError CannotBind(const UdpEndpoint& endpoint, int error) {
  const std::string port = "port " + std::to_string(endpoint.port) + " on " + endpoint.host;
  switch (error) {
    case EADDRINUSE:
      return {port +
                  " is taken by another program; choose another port or end that program (with "
                  "${loopback} as the address each run has ports of its own)",
              error};
    case EADDRNOTAVAIL:
      return {port + " cannot be bound: this machine has no such address; use 127.0.0.1", error};
    case EACCES:
      return {port + " is reserved for root; choose a port above 1023", error};
    default:
      return {port + " cannot be listened on: " + std::strerror(error), error};
  }
}

std::variant<UniqueFd, SocketError> Open() {
  UniqueFd fd(socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  if (fd) return fd;
  const int error = errno;
  return SocketError{std::string("cannot open a UDP socket: ") + std::strerror(error), error};
}

}  // namespace

std::variant<UdpSocket, SocketError> UdpSocket::Bind(const UdpEndpoint& endpoint) {
  const auto address = ToAddress(endpoint);
  if (!address) return NotAnAddress(endpoint);
  std::variant<UdpSocket, SocketError> opened = ForSending();
  if (const auto* socket = std::get_if<UdpSocket>(&opened)) {
    // No SO_REUSEADDR: two programs on one UDP port would share its datagrams by chance.
    if (bind(socket->fd(), reinterpret_cast<const sockaddr*>(&*address), sizeof *address) != 0) {
      return CannotBind(endpoint, errno);
    }
  }
  return opened;
}

std::variant<UdpSocket, SocketError> UdpSocket::ForSending() {
  auto opened = Open();
  if (const auto* error = std::get_if<SocketError>(&opened)) return *error;
  return UdpSocket(std::move(std::get<UniqueFd>(opened)));
}

UdpEndpoint UdpSocket::LocalEndpoint() const {
  sockaddr_in address{};
  socklen_t size = sizeof address;
  getsockname(fd(), reinterpret_cast<sockaddr*>(&address), &size);
  return FromAddress(address);
}

std::optional<SocketError> UdpSocket::SendTo(const UdpEndpoint& to, std::string_view payload) {
  const auto address = ToAddress(to);
  if (!address) return NotAnAddress(to);
  ssize_t sent;
  do {
    sent = sendto(fd(), payload.data(), payload.size(), MSG_NOSIGNAL,
                  reinterpret_cast<const sockaddr*>(&*address), sizeof *address);
  } while (sent < 0 && errno == EINTR);
  if (sent >= 0) return std::nullopt;
  const int error = errno;
  const std::string target = to.host + ":" + std::to_string(to.port);
  if (error == EMSGSIZE) {
    return SocketError{"a datagram of " + std::to_string(payload.size()) + " bytes for " + target +
                           " is longer than a UDP datagram; send fewer bodies in one channel",
                       error};
  }
  return SocketError{"cannot send to " + target + ": " + std::strerror(error), error};
}

std::variant<std::optional<Datagram>, SocketError> UdpSocket::Receive() {
  std::array<char, kLargestPayload> buffer;
  sockaddr_in from{};
  ssize_t size;
  do {
    socklen_t from_size = sizeof from;
    size = recvfrom(fd(), buffer.data(), buffer.size(), 0, reinterpret_cast<sockaddr*>(&from),
                    &from_size);
  } while (size < 0 && errno == EINTR);
  if (size >= 0) {
    return std::optional<Datagram>(
        {std::string(buffer.data(), static_cast<std::size_t>(size)), FromAddress(from)});
  }
  const int error = errno;
  if (error == EAGAIN || error == EWOULDBLOCK) return std::optional<Datagram>();
  const UdpEndpoint local = LocalEndpoint();
  return SocketError{"cannot receive on " + local.host + ":" + std::to_string(local.port) + ": " +
                         std::strerror(error),
                     error};
}

bool IsListenedTo(const UdpEndpoint& endpoint) {
  const auto address = ToAddress(endpoint);
  if (!address || endpoint.host.rfind("127.", 0) != 0) return true;
  for (const bool v6 : {false, true}) {
    std::ifstream table(v6 ? "/proc/net/udp6" : "/proc/net/udp");
    if (!table && !v6) return true;
    std::string line, slot, local;
    std::getline(table, line);  // the head
    while (std::getline(table, line)) {
      std::istringstream(line) >> slot >> local;
      const std::size_t colon = local.find(':');
      if (colon == std::string::npos) continue;
      if (std::stoul(local.substr(colon + 1), nullptr, 16) != endpoint.port) continue;
      // For a socket of the other family it is enough that it has the port.
      if (v6) return true;
      const unsigned long host = std::stoul(local.substr(0, colon), nullptr, 16);
      if (host == 0 || host == address->sin_addr.s_addr) return true;
    }
  }
  return false;
}

shm::ReceiverAddress KernelAddressOf(const UdpEndpoint& endpoint) {
  const auto address = ToAddress(endpoint);
  return address ? shm::AddressOf(&*address, sizeof *address) : shm::ReceiverAddress{};
}

}  // namespace tcs
