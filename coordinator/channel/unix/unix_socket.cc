#include "coordinator/channel/unix/unix_socket.h"

#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <memory>

#include "coordinator/os/guardian.h"

namespace tcs {
namespace {

struct Address {
  sockaddr_un name{};
  socklen_t size = 0;

  // The name fits: the scenario's loader has seen to that.
  explicit Address(const UnixName& of) {
    name.sun_family = AF_UNIX;
    memcpy(name.sun_path + (of.is_abstract ? 1 : 0), of.name.data(), of.name.size());
    size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + of.name.size() + 1);
  }
  const sockaddr* get() const { return reinterpret_cast<const sockaddr*>(&name); }
};

std::variant<UniqueFd, std::string> OpenSocket() {
  UniqueFd fd(socket(AF_UNIX, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  if (fd) return fd;
  return std::string("cannot open a UNIX socket: ") + strerror(errno);
}

std::string CannotBind(const UnixName& name, int error) {
  const std::string what = "the UNIX socket '" + name.Text() + "'";
  switch (error) {
    case EADDRINUSE:
      return what +
             " is taken by another program; end that program, or choose another path (with "
             "${result_dir} or ${run} in it, each run has its own)";
    case ENOENT:
    case ENOTDIR:
      return what +
             " cannot be made because its folder does not exist; make the folder, or choose "
             "another path";
    case EACCES:
    case EPERM:
    case EROFS:
      return what + " cannot be made: " + strerror(error) +
             "; choose a folder in which you may write";
    default:
      return what + " cannot be made: " + strerror(error);
  }
}

// Removes the file of a run that has ended without removing it. 0, or an errno.
int RemoveStale(const UnixName& name) {
  struct stat status;
  if (lstat(name.name.c_str(), &status) != 0) return errno;
  if (!S_ISSOCK(status.st_mode)) return EEXIST;
  if (IsListenedTo(name)) return EADDRINUSE;
  return unlink(name.name.c_str()) == 0 ? 0 : errno;
}

}  // namespace

std::variant<UnixSocket, std::string> UnixSocket::Bind(const UnixName& name) {
  auto opened = OpenSocket();
  if (auto* error = std::get_if<std::string>(&opened)) return std::move(*error);
  UnixSocket bound(std::move(std::get<UniqueFd>(opened)));
  const Address address(name);
  int error = bind(bound.fd(), address.get(), address.size) == 0 ? 0 : errno;
  if (error == EADDRINUSE && !name.is_abstract) {
    error = RemoveStale(name);
    if (error == EEXIST) {
      return "'" + name.Text() +
             "' exists and is not a socket, so no UNIX socket can be made there; choose another "
             "path";
    }
    if (error == 0) error = bind(bound.fd(), address.get(), address.size) == 0 ? 0 : errno;
  }
  if (error != 0) return CannotBind(name, error);
  if (!name.is_abstract) {
    bound.file_ = name.name;
    RemoveIfKilled(bound.file_);
  }
  return bound;
}

std::variant<UnixSocket, std::string> UnixSocket::ForSending() {
  auto opened = OpenSocket();
  if (auto* error = std::get_if<std::string>(&opened)) return std::move(*error);
  return UnixSocket(std::move(std::get<UniqueFd>(opened)));
}

UnixSocket::~UnixSocket() {
  if (!file_.empty()) RemoveNow(file_);
}

bool UnixSocket::SendTo(const UnixName& to, std::string_view payload) {
  const Address address(to);
  ssize_t sent;
  do {
    sent = sendto(fd(), payload.data(), payload.size(), MSG_NOSIGNAL, address.get(), address.size);
  } while (sent < 0 && errno == EINTR);
  return sent >= 0;
}

// Mostly one datagram has come, and one call takes it and finds that there is no second one.
std::vector<std::string> UnixSocket::ReceiveAll() {
  constexpr std::size_t kAtOnce = 2;
  // The kernel touches only the part of the room that it fills.
  thread_local const auto room = std::make_unique_for_overwrite<char[]>(kAtOnce * kLongest);
  std::vector<std::string> all;
  for (;;) {
    std::array<iovec, kAtOnce> parts{};
    std::array<mmsghdr, kAtOnce> messages{};
    for (std::size_t i = 0; i < kAtOnce; ++i) {
      parts[i] = {room.get() + i * kLongest, kLongest};
      messages[i].msg_hdr.msg_iov = &parts[i];
      messages[i].msg_hdr.msg_iovlen = 1;
    }
    const int count = recvmmsg(fd(), messages.data(), kAtOnce, MSG_DONTWAIT, nullptr);
    if (count < 0 && errno == EINTR) continue;
    for (int i = 0; i < count; ++i) {
      const auto at = static_cast<std::size_t>(i);
      all.emplace_back(room.get() + at * kLongest, messages[at].msg_len);
    }
    if (count < static_cast<int>(kAtOnce)) return all;
  }
}

// The process that has the name does not notice that a socket connects to it.
bool IsListenedTo(const UnixName& name) {
  auto opened = OpenSocket();
  if (std::holds_alternative<std::string>(opened)) return true;
  const Address address(name);
  return connect(std::get<UniqueFd>(opened).get(), address.get(), address.size) == 0 ||
         (errno != ECONNREFUSED && errno != ENOENT);
}

shm::ReceiverAddress KernelAddressOf(const UnixName& name) {
  const Address address(name);
  const std::size_t size = address.size - (name.is_abstract ? 0 : 1);
  return shm::AddressOf(address.get(), size);
}

}  // namespace tcs
