#include "coordinator/processes/attach_exchange.h"

#include <sys/socket.h>

#include <cstring>

#include "coordinator/os/passed_fd.h"

namespace tcs {

namespace {

shm::AttachReply NewReply() {
  shm::AttachReply reply{};
  reply.magic = shm::kMagic;
  reply.version = shm::kVersion;
  return reply;
}

void Send(int connection, shm::AttachReply reply, std::span<const int> fds) {
  const PassedMessage message(&reply, sizeof reply, fds);
  sendmsg(connection, message.get(), MSG_NOSIGNAL | MSG_DONTWAIT);
}

pid_t PeerOf(int connection) {
  ucred peer{};
  socklen_t size = sizeof peer;
  getsockopt(connection, SOL_SOCKET, SO_PEERCRED, &peer, &size);
  return peer.pid;
}

}  // namespace

std::optional<shm::AttachHello> PeekHello(int connection) {
  shm::AttachHello hello{};
  const ssize_t n = recv(connection, &hello, sizeof hello, MSG_DONTWAIT | MSG_PEEK);
  if (n != sizeof hello || hello.pid != PeerOf(connection)) return std::nullopt;
  return hello;
}

TakenHello TakeHello(int connection) {
  shm::AttachHello hello{};
  const ssize_t n = recv(connection, &hello, sizeof hello, MSG_DONTWAIT);
  if (n <= 0) return {.has_gone = true};
  const bool is_right = n == sizeof hello && hello.magic == shm::kMagic &&
                        hello.version == shm::kVersion && hello.pid == PeerOf(connection);
  return {.hello = is_right ? std::optional(hello) : std::nullopt};
}

void Accept(int connection, std::uint32_t slot, std::span<const int> fds) {
  shm::AttachReply reply = NewReply();
  reply.slot = slot;
  Send(connection, reply, fds);
}

void Refuse(int connection, const char* why) {
  shm::AttachReply reply = NewReply();
  reply.refused = 1;
  strncpy(reply.text, why, sizeof reply.text - 1);
  Send(connection, reply, {});
}

}  // namespace tcs
