// The calls on sockets, made raw: they wait in the same time as all others.
#include <netinet/in.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/un.h>
#include <sys/wait.h>

#include <vector>

#include "tests/conformance/conformance.h"
#include "tests/conformance/natively_until.h"

namespace {

using namespace conformance;

// A child does `later` 100 ms after the start, while the parent is in `wait`.
template <class Later, class Wait>
void Meanwhile(const char* what, Later later, Wait wait) {
  const std::int64_t start = Now();
  const pid_t pid = fork();
  EXPECT(pid >= 0, "fork");
  if (pid == 0) {
    const timespec until = ToTimespec(start + 100 * kMs);
    clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr);
    later();
    _exit(0);
  }
  wait();
  ExpectSoonAfter(start, 100 * kMs, what);
  int status = 0;
  EXPECT(waitpid(pid, &status, 0) == pid && status == 0, "%s: child status %x", what, status);
}

char g_buffer[4096];

void Receives(int type) {
  int pair[2];
  EXPECT(socketpair(AF_UNIX, type, 0, pair) == 0, "socketpair");
  iovec iov{g_buffer, sizeof g_buffer};
  msghdr message{};
  message.msg_iov = &iov;
  message.msg_iovlen = 1;
  mmsghdr several{};
  several.msg_hdr = message;
  const auto send_raw = [&] {
    EXPECT(syscall(SYS_sendto, pair[1], "abc", 3, 0, nullptr, 0) == 3, "sendto");
  };
  Meanwhile("recvfrom", send_raw, [&] {
    EXPECT(syscall(SYS_recvfrom, pair[0], g_buffer, 8, 0, nullptr, nullptr) == 3, "recvfrom");
  });
  Meanwhile("recvmsg", send_raw,
            [&] { EXPECT(syscall(SYS_recvmsg, pair[0], &message, 0) == 3, "recvmsg"); });
  Meanwhile("recvmmsg", send_raw, [&] {
    EXPECT(syscall(SYS_recvmmsg, pair[0], &several, 1, 0, nullptr) == 1, "recvmmsg");
  });
  Meanwhile(
      "read", [&] { EXPECT(syscall(SYS_sendmsg, pair[1], &message, 0) == 4096, "sendmsg"); },
      [&] { EXPECT(syscall(SYS_read, pair[0], g_buffer, 4096) == 4096, "read"); });
  // SO_RCVTIMEO is virtual, too.
  const timeval timeout{0, 60'000};
  setsockopt(pair[0], SOL_SOCKET, SO_RCVTIMEO, &timeout, sizeof timeout);
  std::int64_t start = Now();
  EXPECT(syscall(SYS_recvfrom, pair[0], g_buffer, 8, 0, nullptr, nullptr) == -1 && errno == EAGAIN,
         "%s", strerror(errno));
  ExpectSoonAfter(start, 60 * kMs, "a timeout");
  start = Now();
  EXPECT(syscall(SYS_read, pair[0], g_buffer, 8) == -1 && errno == EAGAIN, "%s", strerror(errno));
  ExpectSoonAfter(start, 60 * kMs, "a timeout of read");
  start = Now();
  EXPECT(syscall(SYS_recvfrom, pair[0], g_buffer, 8, MSG_DONTWAIT, nullptr, nullptr) == -1 &&
             errno == EAGAIN,
         "%s", strerror(errno));
  ExpectSoonAfter(start, 0, "MSG_DONTWAIT");
  close(pair[0]);
  close(pair[1]);
}

// A socket without room is waited for.
void Sends() {
  int pair[2];
  EXPECT(socketpair(AF_UNIX, SOCK_DGRAM, 0, pair) == 0, "socketpair");
  const auto fill = [&] {
    while (syscall(SYS_sendto, pair[1], g_buffer, 100, MSG_DONTWAIT, nullptr, 0) > 0) {
    }
  };
  const auto drain = [&] {
    while (recv(pair[0], g_buffer, sizeof g_buffer, MSG_DONTWAIT) > 0) {
    }
  };
  iovec iov{g_buffer, 100};
  msghdr message{};
  message.msg_iov = &iov;
  message.msg_iovlen = 1;
  mmsghdr several{};
  several.msg_hdr = message;
  fill();
  Meanwhile("sendto", drain, [&] {
    EXPECT(syscall(SYS_sendto, pair[1], g_buffer, 100, 0, nullptr, 0) == 100, "sendto");
  });
  fill();
  Meanwhile("sendmsg", drain,
            [&] { EXPECT(syscall(SYS_sendmsg, pair[1], &message, 0) == 100, "sendmsg"); });
  fill();
  Meanwhile("sendmmsg", drain,
            [&] { EXPECT(syscall(SYS_sendmmsg, pair[1], &several, 1, 0) == 1, "sendmmsg"); });
  close(pair[0]);
  close(pair[1]);
}

// A write waits once all of the buffer is used; poll says that there is no room long before.
void FillsItsBuffer(int type) {
  int pair[2];
  EXPECT(socketpair(AF_UNIX, type, 0, pair) == 0, "socketpair");
  int size = 0;
  socklen_t length = sizeof size;
  EXPECT(getsockopt(pair[1], SOL_SOCKET, SO_SNDBUF, &size, &length) == 0, "SO_SNDBUF");
  const auto half = static_cast<std::size_t>(size) / 2;
  std::vector<char> bytes(half);
  const auto write_raw = [&] {
    EXPECT(syscall(SYS_write, pair[1], bytes.data(), half) == static_cast<long>(half), "%d", type);
  };
  const std::int64_t start = Now();
  write_raw();
  write_raw();
  ExpectSoonAfter(start, 0, "two halves of a buffer");
  const auto drain = [&] {
    while (recv(pair[0], bytes.data(), half, MSG_DONTWAIT) > 0) {
    }
  };
  Meanwhile("a third half", drain, write_raw);
  close(pair[0]);
  close(pair[1]);
}

void Connections(int number) {
  const int listener = socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  EXPECT(bind(listener, reinterpret_cast<sockaddr*>(&address), size) == 0, "bind");
  EXPECT(listen(listener, 1) == 0, "listen");
  getsockname(listener, reinterpret_cast<sockaddr*>(&address), &size);
  Meanwhile(
      "accept",
      [&] {
        const int client = socket(AF_INET, SOCK_STREAM, 0);
        EXPECT(syscall(SYS_connect, client, &address, size) == 0, "connect: %s", strerror(errno));
      },
      [&] {
        const long accepted = number == SYS_accept
                                  ? syscall(SYS_accept, listener, nullptr, nullptr)
                                  : syscall(SYS_accept4, listener, nullptr, nullptr, SOCK_CLOEXEC);
        EXPECT(accepted >= 0, "accept: %s", strerror(errno));
        close(static_cast<int>(accepted));
      });
  close(listener);
}

// A handler ends the wait, or the call is made again after it.
void Interrupted(int flags, bool restarts) {
  int pair[2];
  EXPECT(socketpair(AF_UNIX, SOCK_STREAM, 0, pair) == 0, "socketpair");
  struct sigaction action {};
  action.sa_handler = [](int) {};
  action.sa_flags = flags;
  sigaction(SIGUSR1, &action, nullptr);
  const pid_t parent = getpid();
  const std::int64_t start = Now();
  const pid_t pid = fork();
  if (pid == 0) {
    usleep(50'000);
    NativelyUntil([=] { return Sleeps(parent); });
    kill(parent, SIGUSR1);
    usleep(50'000);
    _exit(write(pair[1], "abc", 3) == 3 ? 0 : 1);
  }
  const long got = syscall(SYS_recvfrom, pair[0], g_buffer, 8, 0, nullptr, nullptr);
  if (restarts) {
    EXPECT(got == 3, "%ld: %s", got, strerror(errno));
    ExpectSoonAfter(start, 100 * kMs, "a call that is made again");
  } else {
    EXPECT(got == -1 && errno == EINTR, "%ld: %s", got, strerror(errno));
    ExpectSoonAfter(start, 50 * kMs, "an interrupted call");
  }
  waitpid(pid, nullptr, 0);
  close(pair[0]);
  close(pair[1]);
}

}  // namespace

int main(int argc, char** argv) {
  Begin(argc, argv);
  Receives(SOCK_STREAM);
  Receives(SOCK_DGRAM);
  Sends();
  for (const int type : {SOCK_STREAM, SOCK_DGRAM, SOCK_SEQPACKET}) FillsItsBuffer(type);
  Connections(SYS_accept);
  Connections(SYS_accept4);
  Interrupted(0, false);
  Interrupted(SA_RESTART, true);
}
