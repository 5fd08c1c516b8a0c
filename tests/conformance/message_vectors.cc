// The calls that send and receive several buffers or messages at once: they wait as the plain ones.
#include <sys/socket.h>
#include <sys/uio.h>
#include <sys/un.h>
#include <sys/wait.h>

#include "tests/conformance/child_later.h"

using namespace conformance;

namespace {

struct Messages {
  char text[2][8] = {};
  iovec parts[2];
  mmsghdr headers[2] = {};

  Messages() {
    for (int i = 0; i < 2; ++i) {
      parts[i] = {text[i], 4};
      headers[i].msg_hdr.msg_iov = &parts[i];
      headers[i].msg_hdr.msg_iovlen = 1;
    }
  }
};

void Buffers() {
  int fds[2];
  EXPECT(pipe(fds) == 0, "pipe");
  char ab[] = "ab", cd[] = "cd";
  WakesAfterTheDelay(
      "readv",
      [&] {
        const iovec parts[] = {{ab, 2}, {cd, 2}};
        EXPECT(writev(fds[1], parts, 2) == 4, "writev");
      },
      [&] {
        char first[2], second[8];
        const iovec parts[] = {{first, 2}, {second, 8}};
        EXPECT(readv(fds[0], parts, 2) == 4 && second[1] == 'd', "readv: %s", strerror(errno));
      });
}

void Datagrams() {
  int fds[2];
  EXPECT(socketpair(AF_UNIX, SOCK_DGRAM, 0, fds) == 0, "socketpair");
  WakesAfterTheDelay(
      "recvmmsg",
      [&] {
        Messages out;
        EXPECT(sendmmsg(fds[1], out.headers, 2, 0) == 2, "sendmmsg");
      },
      [&] {
        Messages in;
        const int n = recvmmsg(fds[0], in.headers, 2, MSG_WAITFORONE, nullptr);
        EXPECT(n >= 1 && in.headers[0].msg_len == 4, "recvmmsg: %d", n);
      });
  Messages rest;
  recvmmsg(fds[0], rest.headers, 2, MSG_DONTWAIT, nullptr);
  WakesAfterTheDelay(
      "recvmsg",
      [&] {
        Messages out;
        EXPECT(sendmsg(fds[1], &out.headers[0].msg_hdr, 0) == 4, "sendmsg");
      },
      [&] {
        Messages in;
        EXPECT(recvmsg(fds[0], &in.headers[0].msg_hdr, 0) == 4, "recvmsg: %s", strerror(errno));
      });
  EXPECT(recvmmsg(fds[0], rest.headers, 2, MSG_DONTWAIT, nullptr) == -1 && errno == EAGAIN,
         "recvmmsg of nothing");
}

void Connections() {
  const int listener = socket(AF_UNIX, SOCK_STREAM, 0);
  sockaddr_un address{AF_UNIX, {}};
  socklen_t size = sizeof(sa_family_t);  // the kernel chooses a name
  EXPECT(bind(listener, reinterpret_cast<sockaddr*>(&address), size) == 0, "bind");
  size = sizeof address;
  EXPECT(getsockname(listener, reinterpret_cast<sockaddr*>(&address), &size) == 0, "getsockname");
  EXPECT(listen(listener, 2) == 0, "listen");
  WakesAfterTheDelay(
      "accept4",
      [&] {
        const int fd = socket(AF_UNIX, SOCK_STREAM, 0);
        EXPECT(connect(fd, reinterpret_cast<sockaddr*>(&address), size) == 0, "connect");
        EXPECT(send(fd, "hello", 5, 0) == 5, "send");
      },
      [&] {
        const int fd = accept4(listener, nullptr, nullptr, SOCK_CLOEXEC);
        EXPECT(fd >= 0, "accept4: %s", strerror(errno));
        char text[8];
        EXPECT(recv(fd, text, sizeof text, 0) == 5, "recv: %s", strerror(errno));
      });
}

}  // namespace

int main(int argc, char** argv) {
  Begin(argc, argv);
  Buffers();
  Datagrams();
  Connections();
}
