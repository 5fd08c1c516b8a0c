// Datagrams of JSON between processes of one computer: UNIX sockets in the abstract namespace, so
// that an address is a name ("drone/imu") and leaves no file.
#pragma once

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>

namespace examples {

using Json = nlohmann::json;

class Socket {
 public:
  // Sends; receives nothing.
  Socket() : fd_(::socket(AF_UNIX, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0)) {
    if (fd_ < 0) throw std::system_error(errno, std::generic_category(), "cannot make a socket");
  }
  // Receives what is sent to the name.
  explicit Socket(const std::string& name) : Socket() {
    sockaddr_un address{};
    const socklen_t length = Fill(name, &address);
    if (::bind(fd_, reinterpret_cast<const sockaddr*>(&address), length) != 0) {
      throw std::system_error(errno, std::generic_category(), "cannot receive on @" + name);
    }
  }
  ~Socket() { ::close(fd_); }
  Socket(const Socket&) = delete;
  Socket& operator=(const Socket&) = delete;

  // The oldest datagram that is here. None if none is.
  std::optional<Json> Receive() {
    std::array<char, 65536> buffer;
    const ssize_t size = ::recv(fd_, buffer.data(), buffer.size(), 0);
    if (size < 0) return std::nullopt;
    return Json::parse(buffer.data(), buffer.data() + size);
  }

  // The newest datagram that is here; older ones are dropped. None if none came since the last
  // call.
  std::optional<Json> ReceiveNewest() {
    std::array<char, 65536> buffer;
    ssize_t newest = -1;
    for (ssize_t size; (size = ::recv(fd_, buffer.data(), buffer.size(), 0)) >= 0;) newest = size;
    if (newest < 0) return std::nullopt;
    return Json::parse(buffer.data(), buffer.data() + newest);
  }

  // A receiver that is not there (yet), or has no room, misses it.
  void Send(const std::string& name, const Json& message) {
    sockaddr_un address{};
    const socklen_t length = Fill(name, &address);
    const std::string text = message.dump();
    (void)::sendto(fd_, text.data(), text.size(), 0, reinterpret_cast<const sockaddr*>(&address),
                   length);
  }

 private:
  // An abstract name begins with a zero byte.
  static socklen_t Fill(std::string_view name, sockaddr_un* address) {
    address->sun_family = AF_UNIX;
    const std::size_t size = std::min(name.size(), sizeof address->sun_path - 1);
    std::copy_n(name.begin(), size, address->sun_path + 1);
    return static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + size);
  }

  int fd_;
};

}  // namespace examples
