#include "coordinator/processes/attach_exchange.h"

#include <sys/socket.h>

#include <cstring>

#include "coordinator/os/own_number.h"
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

// Numbers the process that speaks as tcsim does. False: the process speaks for another one.
bool Renumber(shm::AttachHello& hello, pid_t peer) {
  if (hello.pid == peer) return true;
  const OwnNumber own = OwnNumberOf(peer);
  if (own.pid_namespace == 0 || own.number != hello.pid) return false;
  hello.tid = hello.tid == hello.pid ? peer : ThreadByOwnNumber(peer, hello.tid);
  hello.pid = peer;
  return true;
}

}  // namespace

std::optional<shm::AttachHello> PeekHello(int connection, pid_t peer) {
  shm::AttachHello hello{};
  const ssize_t n = recv(connection, &hello, sizeof hello, MSG_DONTWAIT | MSG_PEEK);
  if (n != sizeof hello || !Renumber(hello, peer != 0 ? peer : PeerOf(connection))) {
    return std::nullopt;
  }
  return hello;
}

TakenHello TakeHello(int connection, pid_t peer) {
  shm::AttachHello hello{};
  const ssize_t n = recv(connection, &hello, sizeof hello, MSG_DONTWAIT);
  if (n <= 0) return {.has_gone = true};
  const bool is_right = n == sizeof hello && hello.magic == shm::kMagic &&
                        hello.version == shm::kVersion &&
                        Renumber(hello, peer != 0 ? peer : PeerOf(connection));
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
