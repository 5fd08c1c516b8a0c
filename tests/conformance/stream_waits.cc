// What makes a program wait besides an empty socket: full ones, many messages at once, listeners,
// terminals, FIFOs, and the ways to watch them.
#include <fcntl.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/epoll.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/time.h>
#include <sys/uio.h>
#include <sys/un.h>
#include <sys/wait.h>

#include <string>
#include <vector>

#include "tests/conformance/child_later.h"

using namespace conformance;

namespace {

constexpr std::int64_t kTimeout = 40 * kMs;  // the kernel keeps those of sockets in ticks of 4 ms
constexpr std::size_t kMuch = 1'000'000;     // more than any of these holds

void ReadMuch(int fd) {
  std::vector<char> text(kMuch);
  for (std::size_t got = 0; got < kMuch;) {
    const ssize_t n = read(fd, text.data(), kMuch - got);
    EXPECT(n > 0, "read: %s", strerror(errno));
    got += static_cast<std::size_t>(n);
  }
}

void WriteOne(int fd) { EXPECT(write(fd, "x", 1) == 1, "write: %s", strerror(errno)); }
void ReadOne(int fd) {
  char c;
  EXPECT(read(fd, &c, 1) == 1, "read: %s", strerror(errno));
}

// A writer waits until all that it writes has found room.
void LongWrites() {
  const std::vector<char> text(kMuch, 'y');
  auto data = const_cast<char*>(text.data());
  iovec halves[2] = {{data, kMuch / 3}, {data, kMuch - kMuch / 3}};
  msghdr message{};
  message.msg_iov = halves;
  message.msg_iovlen = 2;
  const auto all = static_cast<ssize_t>(kMuch);
  int fds[2];
  EXPECT(pipe(fds) == 0, "pipe");
  WakesAfterTheDelay(
      "a long write", [&] { ReadMuch(fds[0]); },
      [&] { EXPECT(write(fds[1], data, kMuch) == all, "write: %s", strerror(errno)); });
  WakesAfterTheDelay(
      "a long writev", [&] { ReadMuch(fds[0]); },
      [&] { EXPECT(writev(fds[1], halves, 2) == all, "writev: %s", strerror(errno)); });
  EXPECT(socketpair(AF_UNIX, SOCK_STREAM, 0, fds) == 0, "socketpair");
  WakesAfterTheDelay(
      "a long write to a socket", [&] { ReadMuch(fds[0]); },
      [&] { EXPECT(write(fds[1], data, kMuch) == all, "write: %s", strerror(errno)); });
  WakesAfterTheDelay(
      "a long send", [&] { ReadMuch(fds[0]); },
      [&] { EXPECT(send(fds[1], data, kMuch, 0) == all, "send: %s", strerror(errno)); });
  WakesAfterTheDelay(
      "a long sendmsg", [&] { ReadMuch(fds[0]); },
      [&] { EXPECT(sendmsg(fds[1], &message, 0) == all, "sendmsg: %s", strerror(errno)); });
}

// MSG_WAITALL waits for all parts of what is asked for.
void LongReceives() {
  int fds[2];
  EXPECT(socketpair(AF_UNIX, SOCK_STREAM, 0, fds) == 0, "socketpair");
  auto send_parts = [&] {
    for (int i = 0; i < 4; ++i) {
      if (i > 0) usleep(1000);
      WriteOne(fds[1]);
    }
  };
  char text[4];
  const std::int64_t start = Now();
  WakesAfterTheDelay("MSG_WAITALL", send_parts, [&] {
    EXPECT(recv(fds[0], text, 4, MSG_WAITALL) == 4, "recv: %s", strerror(errno));
  });
  ExpectSoonAfter(start, kChildDelay + 3 * kMs, "MSG_WAITALL");
  iovec halves[2] = {{text, 2}, {text + 2, 2}};
  msghdr message{};
  message.msg_iov = halves;
  message.msg_iovlen = 2;
  WakesAfterTheDelay("recvmsg", send_parts, [&] {
    EXPECT(recvmsg(fds[0], &message, MSG_WAITALL) == 4, "recvmsg: %s", strerror(errno));
  });
  // The end of the stream is the end of the wait.
  WriteOne(fds[1]);
  shutdown(fds[1], SHUT_WR);
  EXPECT(recv(fds[0], text, 4, MSG_WAITALL) == 1, "recv at the end: %s", strerror(errno));
}

void SendTimeouts() {
  int fds[2];
  EXPECT(socketpair(AF_UNIX, SOCK_STREAM, 0, fds) == 0, "socketpair");
  const timeval timeout{0, kTimeout / 1000};
  EXPECT(setsockopt(fds[0], SOL_SOCKET, SO_SNDTIMEO, &timeout, sizeof timeout) == 0, "setsockopt");
  const std::vector<char> text(kMuch);
  std::int64_t start = Now();
  const ssize_t sent = send(fds[0], text.data(), kMuch, 0);
  EXPECT(sent > 0 && sent < static_cast<ssize_t>(kMuch), "sent %zd", sent);
  ExpectWaited(start, kTimeout, 2, "a send of more than there is room for");
  while (send(fds[0], "x", 1, MSG_DONTWAIT) == 1) {
  }
  start = Now();
  EXPECT(send(fds[0], "x", 1, 0) == -1 && errno == EAGAIN, "send: %s", strerror(errno));
  ExpectWaited(start, kTimeout, 2, "a send without room");
}

void ManyMessages() {
  int fds[2];
  EXPECT(socketpair(AF_UNIX, SOCK_DGRAM, 0, fds) == 0, "socketpair");
  char texts[3][8];
  iovec iovs[3];
  mmsghdr messages[3] = {};
  for (int i = 0; i < 3; ++i) {
    iovs[i] = {texts[i], 8};
    messages[i].msg_hdr.msg_iov = &iovs[i];
    messages[i].msg_hdr.msg_iovlen = 1;
  }
  timespec timeout = ToTimespec(kTimeout);
  // Natively the timeout is looked at only after a message; SO_RCVTIMEO ends the wait anywhere.
  const timeval limit{0, kTimeout / 1000};
  EXPECT(setsockopt(fds[0], SOL_SOCKET, SO_RCVTIMEO, &limit, sizeof limit) == 0, "setsockopt");
  const std::int64_t start = Now();
  EXPECT(recvmmsg(fds[0], messages, 3, 0, &timeout) == -1 && errno == EAGAIN, "%s",
         strerror(errno));
  ExpectWaited(start, kTimeout, 2, "recvmmsg");
  const timeval none{};
  EXPECT(setsockopt(fds[0], SOL_SOCKET, SO_RCVTIMEO, &none, sizeof none) == 0, "setsockopt");
  WakesAfterTheDelay(
      "recvmmsg",
      [&] { EXPECT(sendmmsg(fds[1], messages, 2, 0) == 2, "sendmmsg: %s", strerror(errno)); },
      [&] {
        int got = recvmmsg(fds[0], messages, 3, MSG_WAITFORONE, nullptr);
        // Natively, on another processor, the first is there before the second has been sent.
        if (g_mode == Mode::kNative && got == 1) {
          got += recvmmsg(fds[0], messages + 1, 1, 0, nullptr);
        }
        EXPECT(got == 2, "recvmmsg: %d, %s", got, strerror(errno));
      });
  EXPECT(messages[0].msg_len == 8 && messages[1].msg_len == 8, "lengths");
  EXPECT(sendmmsg(fds[1], messages, 0, 0) == 0, "sendmmsg of nothing: %s", strerror(errno));
  // A queue holds only so many datagrams: the sender waits for room for the rest.
  std::vector<mmsghdr> many(1000, messages[0]);
  WakesAfterTheDelay(
      "sendmmsg",
      [&] {
        char text[8];
        for (int i = 0; i < 1000; ++i) EXPECT(read(fds[0], text, 8) == 8, "read");
      },
      [&] {
        EXPECT(sendmmsg(fds[1], many.data(), 1000, 0) == 1000, "sendmmsg: %s", strerror(errno));
      });
}

void Listeners() {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const int listener = socket(AF_UNIX, SOCK_STREAM, 0);
  socklen_t size = sizeof address.sun_family;
  auto* raw = reinterpret_cast<sockaddr*>(&address);
  EXPECT(bind(listener, raw, size) == 0 && listen(listener, 0) == 0, "listen");
  size = sizeof address;
  getsockname(listener, raw, &size);

  const timeval limit{0, kTimeout / 1000};
  EXPECT(setsockopt(listener, SOL_SOCKET, SO_RCVTIMEO, &limit, sizeof limit) == 0, "setsockopt");
  std::int64_t start = Now();
  EXPECT(accept(listener, nullptr, nullptr) == -1 && errno == EAGAIN, "accept: %s",
         strerror(errno));
  ExpectWaited(start, kTimeout, 2, "accept");

  // One connection waits to be accepted; a second one has to wait for room.
  const int first = socket(AF_UNIX, SOCK_STREAM, 0), second = socket(AF_UNIX, SOCK_STREAM, 0);
  EXPECT(connect(first, raw, size) == 0, "connect: %s", strerror(errno));
  EXPECT(setsockopt(second, SOL_SOCKET, SO_SNDTIMEO, &limit, sizeof limit) == 0, "setsockopt");
  start = Now();
  EXPECT(connect(second, raw, size) == -1 && errno == EAGAIN, "connect: %s", strerror(errno));
  ExpectWaited(start, kTimeout, 2, "connect");
  const timeval none{};
  EXPECT(setsockopt(second, SOL_SOCKET, SO_SNDTIMEO, &none, sizeof none) == 0, "setsockopt");
  WakesAfterTheDelay(
      "connect", [&] { EXPECT(accept(listener, nullptr, nullptr) >= 0, "accept"); },
      [&] { EXPECT(connect(second, raw, size) == 0, "connect: %s", strerror(errno)); });
  for (const int fd : {listener, first, second}) close(fd);
}

// Both directions of a terminal, in lines and in single characters.
void Terminals() {
  const int master = posix_openpt(O_RDWR | O_NOCTTY);
  EXPECT(master >= 0 && grantpt(master) == 0 && unlockpt(master) == 0, "posix_openpt");
  const int slave = open(ptsname(master), O_RDWR | O_NOCTTY);
  char text[8];
  WakesAfterTheDelay(
      "a line", [&] { EXPECT(write(master, "hi\n", 3) == 3, "write"); },
      [&] { EXPECT(read(slave, text, sizeof text) == 3, "read: %s", strerror(errno)); });
  EXPECT(read(master, text, sizeof text) > 0, "no echo");
  WakesAfterTheDelay(
      "the other way", [&] { EXPECT(write(slave, "ho", 2) == 2, "write"); },
      [&] { EXPECT(read(master, text, sizeof text) == 2, "read: %s", strerror(errno)); });
  WakesAfterTheDelay(
      "poll of a terminal", [&] { EXPECT(write(master, "x\n", 2) == 2, "write"); },
      [&] {
        pollfd fd{slave, POLLIN, 0};
        EXPECT(poll(&fd, 1, 1000) == 1 && fd.revents == POLLIN, "poll: %x", fd.revents);
      });
  WakesAfterTheDelay(
      "the end of a terminal", [&] { close(slave); },
      [&] {
        close(slave);
        EXPECT(read(master, text, sizeof text) > 0, "no echo");
        EXPECT(read(master, text, sizeof text) == -1 && errno == EIO, "read: %s", strerror(errno));
      });
  close(master);
}

void Fifos() {
  char folder[] = "/tmp/conformance.XXXXXX";
  EXPECT(mkdtemp(folder) != nullptr, "mkdtemp");
  const std::string path = std::string(folder) + "/fifo";
  EXPECT(mkfifo(path.c_str(), 0600) == 0, "mkfifo");
  const int reader = open(path.c_str(), O_RDONLY | O_NONBLOCK);
  pollfd fd{reader, POLLIN, 0};
  const std::int64_t start = Now();
  EXPECT(poll(&fd, 1, kTimeout / kMs) == 0, "poll of a FIFO without a writer: %x", fd.revents);
  ExpectWaited(start, kTimeout, 2, "poll of a FIFO");
  WakesAfterTheDelay(
      "poll of a FIFO",
      [&] {
        const int writer = open(path.c_str(), O_WRONLY);
        WriteOne(writer);
        usleep(20'000);
        NativelyUntil([=] {  // it has been read
          int left = 1;
          return ioctl(writer, FIONREAD, &left) == 0 && left == 0;
        });
      },
      [&] {
        EXPECT(poll(&fd, 1, -1) == 1 && fd.revents == POLLIN, "poll: %x", fd.revents);
        ReadOne(reader);
      });
  EXPECT(poll(&fd, 1, -1) == 1 && fd.revents == POLLHUP, "the writer's end: %x", fd.revents);
  unlink(path.c_str());
  rmdir(folder);
  close(reader);
}

int Watching(int fd, std::uint32_t events) {
  const int set = epoll_create1(0);
  epoll_event interest{};
  interest.events = events;
  interest.data.fd = fd;
  EXPECT(epoll_ctl(set, EPOLL_CTL_ADD, fd, &interest) == 0, "epoll_ctl: %s", strerror(errno));
  return set;
}

void Epolls() {
  int fds[2];
  EXPECT(pipe(fds) == 0, "pipe");
  epoll_event event{};
  auto wait = [&](int set, int ms) { return epoll_wait(set, &event, 1, ms); };
  auto write_one = [&] { WriteOne(fds[1]); };

  // A set in a set in a set.
  const int inner = Watching(fds[0], EPOLLIN), middle = Watching(inner, EPOLLIN);
  const int outer = Watching(middle, EPOLLIN);
  std::int64_t start = Now();
  EXPECT(wait(outer, kTimeout / kMs) == 0, "something in empty sets");
  ExpectWaited(start, kTimeout, 2, "nested sets");
  WakesAfterTheDelay("nested sets", write_one, [&] { EXPECT(wait(outer, -1) == 1, "nested"); });
  EXPECT(wait(inner, 0) == 1 && event.data.fd == fds[0], "the innermost set");
  ReadOne(fds[0]);

  // Edges: what is not read away is not told again, what comes in addition is.
  const int edges = Watching(fds[0], EPOLLIN | EPOLLET);
  WakesAfterTheDelay("an edge", write_one, [&] { EXPECT(wait(edges, -1) == 1, "edge"); });
  start = Now();
  EXPECT(wait(edges, kTimeout / kMs) == 0, "an edge was told twice");
  ExpectWaited(start, kTimeout, 2, "no further edge");
  WakesAfterTheDelay("another edge", write_one, [&] { EXPECT(wait(edges, -1) == 1, "edge"); });
  ReadOne(fds[0]);
  ReadOne(fds[0]);

  // Once: told once, until asked for again.
  const int once = Watching(fds[0], EPOLLIN | EPOLLONESHOT);
  WakesAfterTheDelay("one shot", write_one, [&] { EXPECT(wait(once, -1) == 1, "one shot"); });
  start = Now();
  EXPECT(wait(once, kTimeout / kMs) == 0, "one shot was told twice");
  ExpectWaited(start, kTimeout, 2, "after one shot");
  epoll_event interest{};
  interest.events = EPOLLIN | EPOLLONESHOT;
  EXPECT(epoll_ctl(once, EPOLL_CTL_MOD, fds[0], &interest) == 0 && wait(once, -1) == 1, "again");
  ReadOne(fds[0]);
  for (const int fd : {inner, middle, outer, edges, once, fds[0], fds[1]}) close(fd);
}

// Many wait for one token; one gets it, and the others wait on.
void ManyReaders() {
  int tokens[2], done[2];
  EXPECT(pipe(tokens) == 0 && pipe(done) == 0, "pipe");
  pid_t children[3];
  for (pid_t& child : children) {
    child = fork();
    if (child == 0) {
      ReadOne(tokens[0]);
      const std::int64_t now = Now();
      _exit(write(done[1], &now, sizeof now) == sizeof now ? 0 : 1);
    }
  }
  for (int i = 0; i < 3; ++i) {
    usleep(kTimeout / 1000);
    const std::int64_t sent = Now();
    WriteOne(tokens[1]);
    std::int64_t got = 0;
    EXPECT(read(done[0], &got, sizeof got) == sizeof got && got >= sent, "got %lld ns early",
           (long long)(sent - got));
    const std::int64_t most = (g_mode == Mode::kFixed ? 1 : 10) * kMs;
    EXPECT(g_mode == Mode::kNative || got < sent + most, "got %lld ns late",
           (long long)(got - sent));
  }
  for (const pid_t child : children) waitpid(child, nullptr, 0);
}

}  // namespace

int main(int argc, char** argv) {
  Begin(argc, argv);
  LongWrites();
  LongReceives();
  SendTimeouts();
  ManyMessages();
  Listeners();
  Terminals();
  Fifos();
  Epolls();
  ManyReaders();
}
