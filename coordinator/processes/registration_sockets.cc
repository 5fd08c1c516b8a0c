#include "coordinator/processes/registration_sockets.h"

#include <errno.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <stdlib.h>
#include <sys/epoll.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/un.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <string_view>
#include <utility>

#include "coordinator/os/open_file_limit.h"
#include "coordinator/port/clocks.h"
#include "coordinator/port/proc_files.h"
#include "coordinator/port/traps.h"

namespace tcs {

RegistrationSockets::RegistrationSockets(Reactor& reactor)
    : reactor_(reactor),
      name_(fmt::format("tcs.{:07}.{:016x}", getpid(), HostClockNs(CLOCK_MONOTONIC))) {}

std::string RegistrationSockets::Open(const OwnComputer* computer) {
  const auto number = static_cast<std::uint32_t>(sockets_.size());
  const std::string name = fmt::format("{}.{}", name_, number);
  int fd = -1;
  const auto make = [&fd] {
    fd = socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  };
  if (computer == nullptr) {
    make();
  } else if (!InNetworkOf(*computer, make)) {
    return {};
  }
  if (fd < 0) return {};
  sockets_.push_back({UniqueFd(fd), nullptr});
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  memcpy(address.sun_path + 1, name.data(), name.size());
  const auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + name.size());
  if (bind(fd, reinterpret_cast<sockaddr*>(&address), size) != 0 || listen(fd, 256) != 0) {
    return {};
  }
  reactor_.Add(fd, EPOLLIN, {Tag::kListener, number});
  return name;
}

bool RegistrationSockets::Accept(std::uint32_t number) {
  const Socket& socket = sockets_[number];
  UniqueFd fd(accept4(socket.fd.get(), nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK));
  if (!fd) return errno != EMFILE && errno != ENFILE;
  if (IsAmongLastFiles(fd.get())) return false;
  Add({std::move(fd), socket.client});
  return true;
}

void RegistrationSockets::Close() {
  for (Socket& socket : sockets_) {
    if (!socket.fd) continue;
    reactor_.Remove(socket.fd.get());
    socket.fd.Reset();
  }
}

bool RegistrationSockets::ConnectBy(const TrappedCall& call) {
  if (call.number != SYS_connect) return false;
  sockaddr_un address{};
  constexpr std::size_t kName = offsetof(sockaddr_un, sun_path) + 1;
  const std::size_t size = call.args[2];
  if (size <= kName || size > sizeof address || !ReadMemory(call.tid, call.args[1], &address, size))
    return false;
  const std::string_view name(address.sun_path + 1, size - kName);
  const std::string prefix = name_ + '.';
  if (address.sun_family != AF_UNIX || address.sun_path[0] != '\0' || !name.starts_with(prefix)) {
    return false;
  }
  const auto number =
      static_cast<std::size_t>(atoi(std::string(name.substr(prefix.size())).c_str()));
  const pid_t peer = ProcessOfThread(call.tid);
  int ends[2];
  if (number >= sockets_.size() || !sockets_[number].fd || peer <= 0 ||
      socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends) != 0) {
    return AnswerTrapped(call.listener, call.id, -ECONNREFUSED), true;
  }
  UniqueFd ours(ends[0]);
  const UniqueFd theirs(ends[1]);
  fcntl(ours.get(), F_SETFL, O_NONBLOCK);
  const bool given = GiveDescriptor(call, theirs.get(), static_cast<int>(call.args[0]));
  if (given) Add({std::move(ours), sockets_[number].client, peer});
  AnswerTrapped(call.listener, call.id, given ? 0 : -ECONNREFUSED);
  return true;
}

void RegistrationSockets::Add(Connection connection) {
  while (silent_.size() >= kMostSilent) silent_.pop_front();
  const int fd = connection.fd.get();
  silent_.push_back(std::move(connection));
  reactor_.Add(fd, EPOLLIN, {Tag::kConnection, static_cast<std::uint32_t>(fd)});
}

std::optional<RegistrationSockets::Connection> RegistrationSockets::Take(int fd) {
  const auto found = std::find_if(silent_.begin(), silent_.end(),
                                  [fd](const Connection& one) { return one.fd.get() == fd; });
  if (found == silent_.end()) return std::nullopt;
  Connection connection = std::move(*found);
  silent_.erase(found);
  return connection;
}

}  // namespace tcs
