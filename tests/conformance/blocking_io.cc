// A reader blocks until a child, which sleeps first, writes, and a writer until it reads: woken at
// the child's time, not before.
#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <stdlib.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <sys/wait.h>

#include "tests/conformance/child_later.h"

using namespace conformance;

namespace {

void ReadOne(int fd) {
  char c = 0;
  EXPECT(read(fd, &c, 1) == 1 && c == 'z', "read: %s", strerror(errno));
}
void WriteOne(int fd) { EXPECT(write(fd, "z", 1) == 1, "write: %s", strerror(errno)); }

sockaddr_in Loopback() {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  return address;
}

template <class Address>
int Bound(int type, Address* address) {
  const int fd = socket(address->sin_family, type, 0);
  socklen_t size = sizeof *address;
  EXPECT(bind(fd, reinterpret_cast<sockaddr*>(address), size) == 0, "bind: %s", strerror(errno));
  getsockname(fd, reinterpret_cast<sockaddr*>(address), &size);
  return fd;
}

void Pairs() {
  int fds[2];
  EXPECT(pipe(fds) == 0, "pipe");
  WakesAfterTheDelay(
      "a pipe", [&] { WriteOne(fds[1]); }, [&] { ReadOne(fds[0]); });
  for (const int type : {SOCK_STREAM, SOCK_DGRAM, SOCK_SEQPACKET}) {
    EXPECT(socketpair(AF_UNIX, type, 0, fds) == 0, "socketpair");
    WakesAfterTheDelay(
        "a socketpair", [&] { WriteOne(fds[1]); }, [&] { ReadOne(fds[0]); });
  }
}

void Udp() {
  sockaddr_in address = Loopback();
  const int receiver = Bound(SOCK_DGRAM, &address);
  WakesAfterTheDelay(
      "UDP",
      [&] {
        const int sender = socket(AF_INET, SOCK_DGRAM, 0);
        EXPECT(
            sendto(sender, "z", 1, 0, reinterpret_cast<sockaddr*>(&address), sizeof address) == 1,
            "sendto");
      },
      [&] {
        char text[8];
        sockaddr_in from{};
        socklen_t size = sizeof from;
        EXPECT(recvfrom(receiver, text, sizeof text, 0, reinterpret_cast<sockaddr*>(&from),
                        &size) == 1,
               "recvfrom: %s", strerror(errno));
      });
}

// No room in the queue of the receiver's socket, which cannot be polled from the sender's.
void FullQueue() {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  socklen_t size = sizeof address;
  const int receiver = socket(AF_UNIX, SOCK_DGRAM, 0);
  // A name that the kernel chooses.
  EXPECT(bind(receiver, reinterpret_cast<sockaddr*>(&address), sizeof address.sun_family) == 0,
         "bind: %s", strerror(errno));
  getsockname(receiver, reinterpret_cast<sockaddr*>(&address), &size);
  const int sender = socket(AF_UNIX, SOCK_DGRAM, 0);
  const auto send = [&](int flags) {
    return sendto(sender, "z", 1, flags, reinterpret_cast<sockaddr*>(&address), size);
  };
  while (send(MSG_DONTWAIT) == 1) {
  }
  EXPECT(errno == EAGAIN, "a full queue: %s", strerror(errno));
  WakesAfterTheDelay(
      "a full queue", [&] { ReadOne(receiver); },
      [&] { EXPECT(send(0) == 1, "sendto: %s", strerror(errno)); });
}

void Tcp() {
  sockaddr_in address = Loopback();
  const int listener = Bound(SOCK_STREAM, &address);
  EXPECT(listen(listener, 1) == 0, "listen");
  int connection = -1;
  WakesAfterTheDelay(
      "accept",
      [&] {
        const int fd = socket(AF_INET, SOCK_STREAM, 0);
        EXPECT(connect(fd, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0, "connect");
        WriteOne(fd);
        char c;
        EXPECT(read(fd, &c, 1) == 1, "read");
      },
      [&] {
        connection = accept(listener, nullptr, nullptr);
        EXPECT(connection >= 0, "accept: %s", strerror(errno));
        ReadOne(connection);
        WriteOne(connection);
      });
}

void Terminal() {
  const int master = posix_openpt(O_RDWR | O_NOCTTY);
  EXPECT(master >= 0 && grantpt(master) == 0 && unlockpt(master) == 0, "posix_openpt");
  const int slave = open(ptsname(master), O_RDWR | O_NOCTTY);
  EXPECT(slave >= 0, "open: %s", strerror(errno));
  WakesAfterTheDelay(
      "a terminal", [&] { EXPECT(write(master, "z\n", 2) == 2, "write"); },
      [&] { ReadOne(slave); });
}

void EndOfFile() {
  int fds[2];
  EXPECT(pipe(fds) == 0, "pipe");
  const std::int64_t start = Now();
  const pid_t pid = fork();
  if (pid == 0) {
    close(fds[0]);
    usleep(kChildDelay / 1000);
    _exit(0);  // closes the last writing end
  }
  close(fds[1]);
  char c;
  EXPECT(read(fds[0], &c, 1) == 0, "no end of file");
  ExpectSoonAfter(start, kChildDelay, "the end of file");
  waitpid(pid, nullptr, 0);
}

}  // namespace

int main(int argc, char** argv) {
  Begin(argc, argv);
  Pairs();
  Udp();
  FullQueue();
  Tcp();
  Terminal();
  EndOfFile();
}
