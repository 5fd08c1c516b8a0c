// Lengths beyond what the kernel moves in a call, and beyond what a call can return: with a buffer
// by itself it takes a part, or says at once what is wrong; in a list of buffers it is EINVAL.
#include <fcntl.h>
#include <limits.h>
#include <netinet/in.h>
#include <stdint.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/uio.h>
#include <unistd.h>

#include "tests/conformance/conformance.h"

using namespace conformance;

namespace {

constexpr std::size_t kMost = 0x7ffff000, kPage = 4096, kThere = 64;

enum class Kind { kUdp, kTcp, kUnixStream, kUnixDatagram, kSeqpacket, kPipe };
constexpr const char* kNames[] = {"udp",           "tcp",       "unix stream",
                                  "unix datagram", "seqpacket", "pipe"};

struct Pair {
  int from, to;
};

Pair Inet(int type) {
  const int receiver = socket(AF_INET, type, 0), sender = socket(AF_INET, type, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  auto* generic = reinterpret_cast<sockaddr*>(&address);
  EXPECT(bind(receiver, generic, size) == 0, "bind");
  EXPECT(getsockname(receiver, generic, &size) == 0, "getsockname");
  if (type == SOCK_STREAM) EXPECT(listen(receiver, 1) == 0, "listen");
  EXPECT(connect(sender, generic, size) == 0, "connect");
  if (type == SOCK_DGRAM) return {sender, receiver};
  const int accepted = accept(receiver, nullptr, nullptr);
  close(receiver);
  return {sender, accepted};
}

Pair Make(Kind kind) {
  int ends[2] = {-1, -1};
  switch (kind) {
    case Kind::kUdp:
      return Inet(SOCK_DGRAM);
    case Kind::kTcp:
      return Inet(SOCK_STREAM);
    case Kind::kUnixStream:
      EXPECT(socketpair(AF_UNIX, SOCK_STREAM, 0, ends) == 0, "socketpair");
      break;
    case Kind::kUnixDatagram:
      EXPECT(socketpair(AF_UNIX, SOCK_DGRAM, 0, ends) == 0, "socketpair");
      break;
    case Kind::kSeqpacket:
      EXPECT(socketpair(AF_UNIX, SOCK_SEQPACKET, 0, ends) == 0, "socketpair");
      break;
    case Kind::kPipe:
      EXPECT(pipe(ends) == 0, "pipe");
      return {ends[1], ends[0]};
  }
  return {ends[0], ends[1]};
}

bool HasMessages(Kind kind) {
  return kind == Kind::kUdp || kind == Kind::kUnixDatagram || kind == Kind::kSeqpacket;
}

// A few bytes, and nothing behind them; but so low that there could be.
char* Buffer() {
  static char* buffer = [] {
    char* pages = static_cast<char*>(
        mmap(reinterpret_cast<void*>(std::uintptr_t{1} << 40), 2 * kPage, PROT_READ | PROT_WRITE,
             MAP_PRIVATE | MAP_ANONYMOUS | MAP_FIXED_NOREPLACE, -1, 0));
    EXPECT(pages != MAP_FAILED, "mmap: %s", strerror(errno));
    EXPECT(munmap(pages + kPage, kPage) == 0, "munmap");
    return pages + kPage - kThere;
  }();
  return buffer;
}

#define GIVES(wanted, call)                                                              \
  do {                                                                                   \
    errno = 0;                                                                           \
    const ssize_t got_ = (call);                                                         \
    EXPECT((wanted) < 0 ? got_ == -1 && errno == -(wanted) : got_ == (wanted),           \
           "%s, %zx bytes: " #call " gives %zd, %s", name, size, got_, strerror(errno)); \
  } while (false)

void Sends(Kind kind, std::size_t size, int flags) {
  const char* name = kNames[static_cast<int>(kind)];
  const Pair pair = Make(kind);
  char* buffer = Buffer();
  iovec piece{buffer, size}, pieces[] = {{buffer, 4}, {buffer, size}};
  mmsghdr message{};
  message.msg_hdr.msg_iov = &piece;
  message.msg_hdr.msg_iovlen = 1;
  const int wrong = HasMessages(kind) ? -EMSGSIZE : -EFAULT;
  const int in_list = size > SSIZE_MAX ? -EINVAL : wrong;
  if (kind != Kind::kPipe) {
    GIVES(wrong, send(pair.from, buffer, size, flags));
    GIVES(wrong, sendto(pair.from, buffer, size, flags, nullptr, 0));
    GIVES(in_list, sendmsg(pair.from, &message.msg_hdr, flags));
    GIVES(in_list, sendmmsg(pair.from, &message, 1, flags));
  }
  GIVES(size >= SSIZE_MAX ? -EFAULT : wrong, write(pair.from, buffer, size));
  GIVES(in_list, writev(pair.from, &piece, 1));
  if (in_list == -EINVAL) GIVES(-EINVAL, writev(pair.from, pieces, 2));
  close(pair.from);
  close(pair.to);
}

void Receives(Kind kind, std::size_t size, bool is_there) {
  const char* name = kNames[static_cast<int>(kind)];
  const Pair pair = Make(kind);
  char* buffer = Buffer();
  iovec piece{buffer, size};
  mmsghdr message{};
  message.msg_hdr.msg_iov = &piece;
  message.msg_hdr.msg_iovlen = 1;
  const auto supply = [&] {
    if (is_there) EXPECT(write(pair.from, "hello", 5) == 5, "write");
  };
  supply();
  // These fail before the kernel looks for anything to read.
  if (size >= SSIZE_MAX) GIVES(-EFAULT, read(pair.to, buffer, size));
  if (size > SSIZE_MAX) GIVES(-EINVAL, readv(pair.to, &piece, 1));
  if (size > SSIZE_MAX && kind != Kind::kPipe) {
    GIVES(-EINVAL, recvmsg(pair.to, &message.msg_hdr, 0));
    GIVES(-EINVAL, recvmmsg(pair.to, &message, 1, 0, nullptr));
  }
  if (is_there && size < SSIZE_MAX) GIVES(5, read(pair.to, buffer, size));
  if (kind != Kind::kPipe) {
    if (size < SSIZE_MAX) supply();
    GIVES(is_there ? 5 : -EAGAIN, recv(pair.to, buffer, size, is_there ? 0 : MSG_DONTWAIT));
  }
  if (is_there && kind != Kind::kPipe) {
    supply();
    GIVES(5, recvfrom(pair.to, buffer, size, 0, nullptr, nullptr));
    supply();
    if (!HasMessages(kind)) EXPECT(shutdown(pair.from, SHUT_WR) == 0, "shutdown");
    GIVES(5, recv(pair.to, buffer, size, MSG_WAITALL));
  }
  close(pair.from);
  close(pair.to);
}

}  // namespace

int main(int argc, char** argv) {
  Begin(argc, argv);
  for (const std::size_t size :
       {kMost + 1, std::size_t{SSIZE_MAX}, std::size_t{SSIZE_MAX} + 1, std::size_t{SIZE_MAX}}) {
    for (const Kind kind : {Kind::kUdp, Kind::kTcp, Kind::kUnixStream, Kind::kUnixDatagram,
                            Kind::kSeqpacket, Kind::kPipe}) {
      for (const int flags : {0, int{MSG_DONTWAIT}}) {
        Sends(kind, size, MSG_NOSIGNAL | flags);
      }
      for (const bool is_there : {true, false}) Receives(kind, size, is_there);
    }
  }
}
