#include "coordinator/processes/peers.h"

#include <fmt/format.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <iterator>
#include <vector>

#include "coordinator/os/descendants.h"
#include "coordinator/os/socket_server.h"
#include "coordinator/os/socket_tables.h"

namespace tcs {

namespace {

// As the process has it, which may be in a network of its own.
std::string TableOf(const Process& process, std::string_view name) {
  std::ifstream in(fmt::format("/proc/{}/net/{}", process.pid, name), std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

int OptionOf(int fd, int option) {
  int value = -1;
  socklen_t size = sizeof value;
  getsockopt(fd, SOL_SOCKET, option, &value, &size);
  return value;
}

std::vector<InternetSocket> SocketsOf(const Process& process, bool is_tcp) {
  std::vector<InternetSocket> sockets = InternetSocketsOf(TableOf(process, is_tcp ? "tcp" : "udp"));
  std::vector<InternetSocket> six = InternetSocketsOf(TableOf(process, is_tcp ? "tcp6" : "udp6"));
  std::move(six.begin(), six.end(), std::back_inserter(sockets));
  return sockets;
}

}  // namespace

bool Peers::IsOfRun(std::uint64_t inode) {
  const auto [known, is_new] = is_of_run_.try_emplace(inode, false);
  if (!is_new) return known->second;
  const std::vector<pid_t> processes = DescendantsOf(getpid());
  known->second = DescriptorsOfSocket(getpid(), inode) > 0 ||
                  std::any_of(processes.begin(), processes.end(),
                              [inode](pid_t pid) { return DescriptorsOfSocket(pid, inode) > 0; });
  return known->second;
}

// The remote address of a socket that is still being connected is in the kernel's tables only.
std::optional<InternetAddress> Peers::RemoteOf(const Process& process, int fd, bool is_tcp,
                                               sockaddr_storage* peer) {
  socklen_t size = sizeof *peer;
  if (getpeername(fd, reinterpret_cast<sockaddr*>(peer), &size) == 0) return AddressIn(*peer);
  peer->ss_family = AF_UNSPEC;
  struct stat status;
  if (fstat(fd, &status) != 0) return std::nullopt;
  for (const InternetSocket& socket : SocketsOf(process, is_tcp)) {
    if (socket.inode == status.st_ino && socket.remote.port != 0) return socket.remote;
  }
  return std::nullopt;
}

// The server by the process's tables, where the kernel says it in no other way. A socket that
// listens there goes first: it is the same one for all connections.
std::uint64_t Peers::ServerInTables(const Process& process, const InternetAddress& remote,
                                    bool is_tcp) {
  std::uint64_t server = 0;
  for (const InternetSocket& each : SocketsOf(process, is_tcp)) {
    const bool serves = each.inode != 0 && each.local.port == remote.port &&
                        (each.local.host == remote.host || each.local.IsAny());
    if (serves && (server == 0 || each.listens)) server = each.inode;
  }
  return server;
}

std::optional<Peers::Peer> Peers::InternetPeer(const Process& process, int fd) {
  // Hosts of their own reach each other only.
  if (run_.scenario.network.has_value()) return std::nullopt;
  const bool is_tcp = OptionOf(fd, SO_TYPE) == SOCK_STREAM;
  sockaddr_storage address{};
  const std::optional<InternetAddress> remote = RemoteOf(process, fd, is_tcp, &address);
  if (!remote.has_value()) return std::nullopt;
  Peer peer{remote->Text()};
  if (!remote->IsLoopback()) {
    const std::vector<std::string> own = OwnAddresses();
    peer.is_outside = std::find(own.begin(), own.end(), remote->host) == own.end();
    if (peer.is_outside) return peer;
  }
  std::optional<std::uint64_t> server;
  if (address.ss_family != AF_UNSPEC) server = ServerOf(fd, address);
  if (server.value_or(0) == 0) server = ServerInTables(process, *remote, is_tcp);
  peer.is_outside = *server != 0 && !IsOfRun(*server);
  return peer;
}

std::optional<Peers::Peer> Peers::UnixPeer(const Process& process, int fd) {
  sockaddr_un address{};
  socklen_t size = sizeof address;
  if (getpeername(fd, reinterpret_cast<sockaddr*>(&address), &size) != 0) return std::nullopt;
  constexpr socklen_t kBegin = offsetof(sockaddr_un, sun_path);
  if (size <= kBegin) return std::nullopt;
  std::string name(address.sun_path, size - kBegin);
  const bool is_abstract = name[0] == '\0';
  if (is_abstract) {
    std::replace(name.begin(), name.end(), '\0', '@');  // as the kernel writes it
  } else {
    name = name.c_str();
  }
  Peer peer{name};
  ucred maker{};
  socklen_t maker_size = sizeof maker;
  getsockopt(fd, SOL_SOCKET, SO_PEERCRED, &maker, &maker_size);
  // The process that has made the listener is looked at first, which costs less than to look for
  // the listener.
  if (maker.pid == getpid() || run_.table.LivingProcess(maker.pid) != nullptr) return peer;
  const std::vector<UnixSocket> sockets = UnixSocketsOf(TableOf(process, "unix"));
  const bool is_stream = OptionOf(fd, SO_TYPE) != SOCK_DGRAM;
  const auto server = std::find_if(sockets.begin(), sockets.end(), [&](const UnixSocket& each) {
    return each.name == name && each.listens == is_stream;
  });
  peer.is_outside = server != sockets.end() && !IsOfRun(server->inode);
  return peer;
}

std::optional<Peers::Peer> Peers::Of(const Process& process, int fd) {
  switch (OptionOf(fd, SO_DOMAIN)) {
    case AF_UNIX:
      return UnixPeer(process, fd);
    case AF_INET:
    case AF_INET6:
      return InternetPeer(process, fd);
    default:
      return std::nullopt;
  }
}

}  // namespace tcs
