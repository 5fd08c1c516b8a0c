#include "coordinator/processes/attach_exchange.h"

#include <sys/socket.h>

#include <cstring>

namespace tcs {

namespace {

shm::AttachReply NewReply() {
  shm::AttachReply reply{};
  reply.magic = shm::kMagic;
  reply.version = shm::kVersion;
  return reply;
}

void Send(int connection, shm::AttachReply reply, std::span<const int> fds) {
  iovec iov{&reply, sizeof reply};
  alignas(cmsghdr) char control[CMSG_SPACE(shm::kMostAttachFds * sizeof(int))] = {};
  msghdr message{};
  message.msg_iov = &iov;
  message.msg_iovlen = 1;
  if (!fds.empty()) {
    message.msg_control = control;
    message.msg_controllen = CMSG_SPACE(fds.size_bytes());
    cmsghdr* header = CMSG_FIRSTHDR(&message);
    header->cmsg_level = SOL_SOCKET;
    header->cmsg_type = SCM_RIGHTS;
    header->cmsg_len = CMSG_LEN(fds.size_bytes());
    memcpy(CMSG_DATA(header), fds.data(), fds.size_bytes());
  }
  sendmsg(connection, &message, MSG_NOSIGNAL | MSG_DONTWAIT);
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
