// The kernel's tables of sockets: /proc/PID/net/tcp, tcp6, udp, udp6 and unix, as texts. Pure, but
// for the last two.
#pragma once

#include <sys/socket.h>
#include <sys/types.h>

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace tcs {

// An address and a port.
struct InternetAddress {
  std::string host;  // as inet_ntop writes it; of an IPv4 address in IPv6 the IPv4 address
  std::uint16_t port = 0;

  std::string Text() const;  // HOST:PORT, or [HOST]:PORT
  bool IsAny() const { return host == "0.0.0.0" || host == "::"; }
  bool IsLoopback() const { return host.starts_with("127.") || host == "::1"; }
  bool operator==(const InternetAddress&) const = default;
};

// The host and port in an IPv4 or IPv6 address.
InternetAddress AddressIn(const sockaddr_storage& address);

struct InternetSocket {
  InternetAddress local, remote;
  bool listens = false;     // of TCP
  std::uint64_t inode = 0;  // 0: of a connection that nobody has accepted yet, or that is closed
};
// The sockets in tcp, tcp6, udp or udp6; lines that are no sockets are left out.
std::vector<InternetSocket> InternetSocketsOf(std::string_view table);

struct UnixSocket {
  bool listens = false;
  std::uint64_t inode = 0;
  std::string name;  // a path, or '@' and an abstract name; empty: none
};
std::vector<UnixSocket> UnixSocketsOf(std::string_view table);

// How many descriptors of the socket with that inode the process has; 0 also where the process
// cannot be looked into.
int DescriptorsOfSocket(pid_t pid, std::uint64_t inode);

// The addresses of this computer's interfaces, as InternetAddress::host has them.
std::vector<std::string> OwnAddresses();

}  // namespace tcs
