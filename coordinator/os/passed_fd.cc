#include "coordinator/os/passed_fd.h"

#include <errno.h>
#include <string.h>

#include "shm/check.h"

namespace tcs {

std::optional<SocketPair> SocketPair::Make() {
  int ends[2];
  if (socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends) != 0) return std::nullopt;
  return SocketPair{UniqueFd(ends[0]), UniqueFd(ends[1])};
}

PassedMessage::PassedMessage(void* bytes, std::size_t size, std::span<const int> fds)
    : iov_{bytes, size} {
  TCS_CHECK(fds.size() <= shm::kMostAttachFds);
  message_.msg_iov = &iov_;
  message_.msg_iovlen = 1;
  if (fds.empty()) return;
  message_.msg_control = control_;
  message_.msg_controllen = CMSG_SPACE(fds.size_bytes());
  cmsghdr* header = CMSG_FIRSTHDR(&message_);
  header->cmsg_level = SOL_SOCKET;
  header->cmsg_type = SCM_RIGHTS;
  header->cmsg_len = CMSG_LEN(fds.size_bytes());
  memcpy(CMSG_DATA(header), fds.data(), fds.size_bytes());
}

Passed ReceivePassed(int socket, void* to, std::size_t size, int flags) {
  iovec iov{to, size};
  // Descriptors that do not fit are closed by the kernel.
  alignas(cmsghdr) char control[CMSG_SPACE(sizeof(int)) + CMSG_SPACE(sizeof(ucred))];
  msghdr message{};
  message.msg_iov = &iov;
  message.msg_iovlen = 1;
  message.msg_control = control;
  message.msg_controllen = sizeof control;
  Passed passed;
  do {
    passed.size = recvmsg(socket, &message, flags | MSG_CMSG_CLOEXEC);
  } while (passed.size < 0 && errno == EINTR);
  if (passed.size < 0) return passed;
  for (cmsghdr* header = CMSG_FIRSTHDR(&message); header != nullptr;
       header = CMSG_NXTHDR(&message, header)) {
    if (header->cmsg_level != SOL_SOCKET) continue;
    if (header->cmsg_type == SCM_CREDENTIALS) {
      ucred sender{};
      memcpy(&sender, CMSG_DATA(header), sizeof sender);
      passed.sender = sender.pid;
    } else if (header->cmsg_type == SCM_RIGHTS) {
      // Room for several descriptors may be left where no credentials came.
      for (std::size_t at = CMSG_LEN(0); at + sizeof(int) <= header->cmsg_len; at += sizeof(int)) {
        int fd = -1;
        memcpy(&fd, CMSG_DATA(header) + (at - CMSG_LEN(0)), sizeof fd);
        UniqueFd taken(fd);
        if (!passed.fd) passed.fd = std::move(taken);
      }
    }
  }
  return passed;
}

}  // namespace tcs
