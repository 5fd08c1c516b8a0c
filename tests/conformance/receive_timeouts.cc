// SO_RCVTIMEO on all kinds of receiving, and of reading.
#include <sys/socket.h>
#include <sys/time.h>
#include <sys/uio.h>

#include "tests/conformance/conformance.h"

using namespace conformance;

int main(int argc, char** argv) {
  Begin(argc, argv);
  int fds[2];
  EXPECT(socketpair(AF_UNIX, SOCK_DGRAM, 0, fds) == 0, "socketpair");
  const timeval timeout{0, 40'000};  // the kernel keeps it in ticks: whole ones at any rate
  EXPECT(setsockopt(fds[0], SOL_SOCKET, SO_RCVTIMEO, &timeout, sizeof timeout) == 0, "setsockopt");
  char text[16];
  const std::size_t room = argc > 100 ? 4 : sizeof text;  // unknown to the compiler

  std::int64_t start = Now();
  EXPECT(recv(fds[0], text, room, 0) == -1 && errno == EAGAIN, "recv: %s", strerror(errno));
  ExpectWaited(start, 40 * kMs, 2, "recv");

  start = Now();
  EXPECT(recvfrom(fds[0], text, room, 0, nullptr, nullptr) == -1 && errno == EAGAIN, "recvfrom");
  ExpectWaited(start, 40 * kMs, 2, "recvfrom");

  iovec iov{text, sizeof text};
  msghdr message{};
  message.msg_iov = &iov;
  message.msg_iovlen = 1;
  start = Now();
  EXPECT(recvmsg(fds[0], &message, 0) == -1 && errno == EAGAIN, "recvmsg");
  ExpectWaited(start, 40 * kMs, 2, "recvmsg");

  start = Now();
  EXPECT(read(fds[0], text, room) == -1 && errno == EAGAIN, "read: %s", strerror(errno));
  ExpectWaited(start, 40 * kMs, 2, "read");

  start = Now();
  EXPECT(readv(fds[0], &iov, 1) == -1 && errno == EAGAIN, "readv: %s", strerror(errno));
  ExpectWaited(start, 40 * kMs, 2, "readv");

  start = Now();
  EXPECT(recv(fds[0], text, room, MSG_DONTWAIT) == -1 && errno == EAGAIN, "MSG_DONTWAIT");
  ExpectWaited(start, 0, 2, "MSG_DONTWAIT");

  EXPECT(send(fds[1], "data", 4, 0) == 4, "send");
  start = Now();
  EXPECT(recv(fds[0], text, room, 0) == 4, "recv missed what was there");
  ExpectWaited(start, 0, 2, "recv of what is there");
}
