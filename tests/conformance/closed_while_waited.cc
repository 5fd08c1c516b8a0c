// A descriptor is closed, replaced (dup2), or closed and its number used again, while another
// thread waits in a call on it. The call keeps its file: it ends when that has something for it, at
// that time, and takes nothing from what its number means by then. When it is over so is the file,
// if that was its last descriptor. Polls are woken by the file, and look for it by its number.
#include <fcntl.h>
#include <mqueue.h>
#include <netinet/in.h>
#include <poll.h>
#include <pthread.h>
#include <pty.h>
#include <signal.h>
#include <sys/epoll.h>
#include <sys/eventfd.h>
#include <sys/select.h>
#include <sys/sendfile.h>
#include <sys/signalfd.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/timerfd.h>
#include <sys/uio.h>
#include <sys/un.h>
#include <sys/wait.h>

#include <functional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "tests/conformance/conformance.h"
#include "tests/conformance/natively_until.h"

namespace {

using namespace conformance;

enum class Fate { kClosed, kReplaced, kUsedAgain };
constexpr Fate kFates[] = {Fate::kClosed, Fate::kReplaced, Fate::kUsedAgain};

constexpr std::int64_t kGoneAfter = 20 * kMs, kComesAfter = 40 * kMs;

std::string g_what;  // is being tested

std::string NameOf(Fate fate) {
  return fate == Fate::kClosed ? " closed" : fate == Fate::kReplaced ? " replaced" : " used again";
}

void SleepUntil(std::int64_t until) {
  const timespec t = ToTimespec(until);
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &t, nullptr) == EINTR) {
  }
}

// The descriptor means something else from now on, or nothing.
void Meet(Fate fate, int fd, int other) {
  if (fate == Fate::kReplaced) {
    EXPECT(dup2(other, fd) == fd, "dup2: %s", strerror(errno));
    return;
  }
  EXPECT(close(fd) == 0, "close: %s", strerror(errno));
  if (fate == Fate::kClosed) return;
  // Up to that number all are taken, for this program opens nothing beside it.
  std::vector<int> below;
  for (;;) {
    const int copy = dup(other);
    EXPECT(copy >= 0 && copy <= fd, "dup: %d instead of %d", copy, fd);
    if (copy == fd) break;
    below.push_back(copy);
  }
  for (const int copy : below) close(copy);
}

// This thread is in `call`, on `fd`, which meets its fate after 20 ms; what `end` does after 40 ms
// ends the call.
void Meanwhile(Fate fate, int fd, int other, const std::function<void()>& call,
               const std::function<void()>& end, std::int64_t ends_after = kComesAfter) {
  const std::int64_t start = Now();
  const pid_t caller = gettid();
  std::thread closer([&] {
    SleepUntil(start + kGoneAfter);
    NativelyUntil([&] { return Sleeps(caller); });
    Meet(fate, fd, other);
    SleepUntil(start + kComesAfter);
    end();
  });
  call();
  const std::int64_t passed = Now() - start;
  closer.join();
  EXPECT(passed >= ends_after, "%s: over after %lld ns", g_what.c_str(), (long long)passed);
  if (g_mode != Mode::kNative) {
    // Where it is measured, what a thread's birth and 300 kB cost is the host's.
    const std::int64_t slack = g_mode == Mode::kFixed ? 100 * kCallNs : 15 * kMs;
    EXPECT(passed < ends_after + slack, "%s: over after %lld ns", g_what.c_str(),
           (long long)passed);
  }
}

// A pipe that has the number afterwards: what is in it stays there, and nothing is added.
class Other {
 public:
  explicit Other(bool is_full) : is_full_(is_full) {
    EXPECT(pipe2(ends_, O_NONBLOCK) == 0, "pipe2");
    if (is_full) EXPECT(write(ends_[1], kWrong, 5) == 5, "write");
  }
  ~Other() {
    char text[16];
    const ssize_t n = read(ends_[0], text, sizeof text);
    EXPECT(n == (is_full_ ? 5 : -1) && (n < 0 || memcmp(text, kWrong, 5) == 0),
           "%s: what has its number was read or written", g_what.c_str());
    close(ends_[0]);
    close(ends_[1]);
  }
  int end(int which) const { return ends_[which]; }

 private:
  static constexpr char kWrong[] = "WRONG";
  const bool is_full_;
  int ends_[2];
};

void CloseIfOpen(Fate fate, int fd) {
  if (fate != Fate::kClosed) close(fd);
}

// ---- What reads.

constexpr char kText[] = "abcdefgh";
constexpr long kSize = 8;

struct Reader {
  const char* name;
  std::function<long(int fd, char* text)> read;
  bool of_sockets = false;
};

msghdr MessageOf(iovec& iov) {
  msghdr message{};
  message.msg_iov = &iov;
  message.msg_iovlen = 1;
  return message;
}

const Reader kReaders[] = {
    {"read", [](int fd, char* text) { return read(fd, text, kSize); }},
    {"readv",
     [](int fd, char* text) {
       iovec iov[] = {{text, 3}, {text + 3, kSize - 3}};
       return readv(fd, iov, 2);
     }},
    {"raw read", [](int fd, char* text) { return syscall(SYS_read, fd, text, kSize); }},
    {"raw readv",
     [](int fd, char* text) {
       iovec iov[] = {{text, 3}, {text + 3, kSize - 3}};
       return syscall(SYS_readv, fd, iov, 2);
     }},
    {"recv", [](int fd, char* text) { return recv(fd, text, kSize, 0); }, true},
    {"recvfrom",
     [](int fd, char* text) {
       sockaddr_storage from{};
       socklen_t size = sizeof from;
       return recvfrom(fd, text, kSize, 0, reinterpret_cast<sockaddr*>(&from), &size);
     },
     true},
    {"recvmsg",
     [](int fd, char* text) {
       iovec iov{text, kSize};
       msghdr message = MessageOf(iov);
       return recvmsg(fd, &message, 0);
     },
     true},
    {"recvmmsg",
     [](int fd, char* text) {
       iovec iov{text, kSize};
       mmsghdr several{};
       several.msg_hdr = MessageOf(iov);
       const int got = recvmmsg(fd, &several, 1, 0, nullptr);
       return got == 1 ? long{several.msg_len} : long{got};
     },
     true},
    {"raw recvfrom",
     [](int fd, char* text) { return syscall(SYS_recvfrom, fd, text, kSize, 0, 0, 0); }, true},
    {"raw recvmsg",
     [](int fd, char* text) {
       iovec iov{text, kSize};
       msghdr message = MessageOf(iov);
       return syscall(SYS_recvmsg, fd, &message, 0);
     },
     true},
    {"raw recvmmsg",
     [](int fd, char* text) {
       iovec iov{text, kSize};
       mmsghdr several{};
       several.msg_hdr = MessageOf(iov);
       const long got = syscall(SYS_recvmmsg, fd, &several, 1, 0, nullptr);
       return got == 1 ? long{several.msg_len} : got;
     },
     true},
};

enum class Kind { kPipe, kStream, kDatagram, kSequence, kTcp, kUdp };

// ends[1] is written to.
void MakePair(Kind kind, int (&ends)[2]) {
  if (kind == Kind::kPipe) {
    EXPECT(pipe(ends) == 0, "pipe");
  } else if (kind == Kind::kStream || kind == Kind::kDatagram || kind == Kind::kSequence) {
    const int type = kind == Kind::kStream     ? SOCK_STREAM
                     : kind == Kind::kDatagram ? SOCK_DGRAM
                                               : SOCK_SEQPACKET;
    EXPECT(socketpair(AF_UNIX, type, 0, ends) == 0, "socketpair");
  } else {
    const int type = kind == Kind::kTcp ? SOCK_STREAM : SOCK_DGRAM;
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    auto* const raw = reinterpret_cast<sockaddr*>(&address);
    int first = socket(AF_INET, type, 0);
    EXPECT(bind(first, raw, size) == 0 && getsockname(first, raw, &size) == 0, "bind");
    if (kind == Kind::kTcp) EXPECT(listen(first, 1) == 0, "listen");
    ends[1] = socket(AF_INET, type, 0);
    EXPECT(connect(ends[1], raw, size) == 0, "connect: %s", strerror(errno));
    if (kind == Kind::kTcp) {
      const int listener = std::exchange(first, accept(first, nullptr, nullptr));
      close(listener);
    }
    ends[0] = first;
  }
}

// The file was open for the call only, and is not any more: who writes is told.
void ExpectClosed(Kind kind, int writer) {
  if (kind == Kind::kUdp) return;  // an error would come late
  if (kind == Kind::kTcp) {
    pollfd hung_up{writer, POLLRDHUP, 0};
    EXPECT(poll(&hung_up, 1, 10'000) == 1, "%s: the connection is still there", g_what.c_str());
    return;
  }
  const ssize_t n = write(writer, "x", 1);
  EXPECT(n == -1 && (errno == EPIPE || errno == ECONNREFUSED || errno == ECONNRESET),
         "%s: still open after the call (%zd, %s)", g_what.c_str(), n, strerror(errno));
}

void Reads(Kind kind, const Reader& reader, Fate fate, bool is_full) {
  int ends[2];
  MakePair(kind, ends);
  const Other other(is_full);
  char text[kSize + 1] = {};
  long got = -1;
  Meanwhile(
      fate, ends[0], other.end(0), [&] { got = reader.read(ends[0], text); },
      [&] { EXPECT(write(ends[1], kText, kSize) == kSize, "write: %s", strerror(errno)); });
  EXPECT(got == kSize, "%s: %ld (%s)", g_what.c_str(), got, strerror(errno));
  EXPECT(strcmp(text, kText) == 0, "%s: '%s'", g_what.c_str(), text);
  ExpectClosed(kind, ends[1]);
  CloseIfOpen(fate, ends[0]);
  close(ends[1]);
}

void AllReads(Fate fate) {
  constexpr struct {
    Kind kind;
    const char* name;
  } kKinds[] = {{Kind::kPipe, " of a pipe"},          {Kind::kStream, " of a stream"},
                {Kind::kDatagram, " of datagrams"},   {Kind::kSequence, " of a sequence"},
                {Kind::kTcp, " of a TCP connection"}, {Kind::kUdp, " of UDP"}};
  bool is_full = false;
  for (const auto& kind : kKinds) {
    for (const Reader& reader : kReaders) {
      if (reader.of_sockets && kind.kind == Kind::kPipe) continue;
      g_what = reader.name + std::string(kind.name) + NameOf(fate);
      Reads(kind.kind, reader, fate, is_full = !is_full);
    }
  }
}

// The end of the file comes, too, whoever has the number.
void EndsOfFile(Fate fate) {
  for (const Kind kind : {Kind::kPipe, Kind::kStream, Kind::kTcp}) {
    for (const Reader& reader : {kReaders[0], kReaders[2]}) {
      g_what = reader.name + std::string(" to the end of one") + NameOf(fate);
      int ends[2];
      MakePair(kind, ends);
      const Other other(true);
      char text[kSize];
      long got = -1;
      Meanwhile(
          fate, ends[0], other.end(0), [&] { got = reader.read(ends[0], text); },
          [&] { close(ends[1]); });
      EXPECT(got == 0, "%s: %ld", g_what.c_str(), got);
      CloseIfOpen(fate, ends[0]);
    }
  }
}

// Parts that come one after the other, long after the number is another's.
void AllOfIt(Fate fate) {
  g_what = "MSG_WAITALL" + NameOf(fate);
  int ends[2];
  MakePair(Kind::kStream, ends);
  const Other other(true);
  char text[kSize + 1] = {};
  Meanwhile(
      fate, ends[0], other.end(0),
      [&] { EXPECT(recv(ends[0], text, kSize, MSG_WAITALL) == kSize, "%s", g_what.c_str()); },
      [&] {
        for (int i = 0; i < kSize; ++i) {
          if (i > 0) usleep(1000);
          EXPECT(write(ends[1], kText + i, 1) == 1, "write");
        }
      },
      kComesAfter + (kSize - 1) * kMs);
  EXPECT(strcmp(text, kText) == 0, "%s: '%s'", g_what.c_str(), text);
  ExpectClosed(Kind::kStream, ends[1]);
  CloseIfOpen(fate, ends[0]);
  close(ends[1]);
}

void Counters(Fate fate) {
  const Other other(false);
  std::uint64_t count = 0;
  for (const bool raw : {false, true}) {
    g_what = std::string(raw ? "raw " : "") + "read of an eventfd" + NameOf(fate);
    const int event = eventfd(0, 0), writer = dup(event);
    Meanwhile(
        fate, event, other.end(0),
        [&] {
          const long got = raw ? syscall(SYS_read, event, &count, 8) : read(event, &count, 8);
          EXPECT(got == 8 && count == 7, "%s: %ld", g_what.c_str(), got);
        },
        [&] { EXPECT(eventfd_write(writer, 7) == 0, "write"); });
    CloseIfOpen(fate, event);
    close(writer);
  }
  // Another event descriptor in its place, which nothing tells apart by what it is.
  g_what = "read of an eventfd, another one in its place," + NameOf(fate);
  const int first = eventfd(0, 0), writer = dup(first), second = eventfd(3, EFD_NONBLOCK);
  Meanwhile(
      fate, first, second,
      [&] { EXPECT(read(first, &count, 8) == 8 && count == 5, "%s", g_what.c_str()); },
      [&] { EXPECT(eventfd_write(writer, 5) == 0, "write"); });
  EXPECT(read(second, &count, 8) == 8 && count == 3, "%s: taken", g_what.c_str());
  CloseIfOpen(fate, first);
  close(writer);
  close(second);
}

void Timers(Fate fate) {
  g_what = "read of a timerfd" + NameOf(fate);
  const Other other(true);
  const int timer = timerfd_create(CLOCK_MONOTONIC, 0);
  const itimerspec in{{0, 0}, {0, kComesAfter}};
  std::uint64_t count = 0;
  Meanwhile(
      fate, timer, other.end(0),
      [&] {
        EXPECT(timerfd_settime(timer, 0, &in, nullptr) == 0, "timerfd_settime");
        EXPECT(read(timer, &count, 8) == 8 && count == 1, "%s: %s", g_what.c_str(),
               strerror(errno));
      },
      [] {});
  CloseIfOpen(fate, timer);
}

void Signals(Fate fate) {
  g_what = "read of a signalfd" + NameOf(fate);
  const Other other(true);
  sigset_t set;
  sigemptyset(&set);
  sigaddset(&set, SIGUSR2);
  pthread_sigmask(SIG_BLOCK, &set, nullptr);
  const int signals = signalfd(-1, &set, 0);
  signalfd_siginfo info{};
  Meanwhile(
      fate, signals, other.end(0),
      [&] {
        const ssize_t got = read(signals, &info, sizeof info);
        EXPECT(got == sizeof info && info.ssi_signo == SIGUSR2, "%s: %zd (%s)", g_what.c_str(), got,
               strerror(errno));
      },
      [] { kill(getpid(), SIGUSR2); });
  CloseIfOpen(fate, signals);
}

void Terminals(Fate fate) {
  g_what = "read of a terminal" + NameOf(fate);
  const Other other(true);
  int leader = -1, follower = -1;
  EXPECT(openpty(&leader, &follower, nullptr, nullptr, nullptr) == 0, "openpty");
  char text[kSize + 1] = {};
  Meanwhile(
      fate, follower, other.end(0),
      [&] { EXPECT(read(follower, text, kSize) == 4, "%s: %s", g_what.c_str(), strerror(errno)); },
      [&] { EXPECT(write(leader, "abc\n", 4) == 4, "write"); });
  EXPECT(strcmp(text, "abc\n") == 0, "%s: '%s'", g_what.c_str(), text);
  CloseIfOpen(fate, follower);
  close(leader);
}

// ---- What writes. More than there is room for, of which the reader finds all.

constexpr std::size_t kMuch = 300'000;

std::vector<char> Much() {
  std::vector<char> text(kMuch);
  for (std::size_t i = 0; i < kMuch; ++i) text[i] = static_cast<char>('a' + i % 23);
  return text;
}

struct Writer {
  const char* name;
  std::function<long(int fd, char* text, std::size_t size)> write;
  bool of_sockets = false;
};

const Writer kWriters[] = {
    {"write", [](int fd, char* text, std::size_t size) { return write(fd, text, size); }},
    {"writev",
     [](int fd, char* text, std::size_t size) {
       iovec iov[] = {{text, size / 3}, {text + size / 3, size - size / 3}};
       return writev(fd, iov, 2);
     }},
    {"raw write",
     [](int fd, char* text, std::size_t size) { return syscall(SYS_write, fd, text, size); }},
    {"raw writev",
     [](int fd, char* text, std::size_t size) {
       iovec iov[] = {{text, size / 3}, {text + size / 3, size - size / 3}};
       return syscall(SYS_writev, fd, iov, 2);
     }},
    {"send", [](int fd, char* text, std::size_t size) { return send(fd, text, size, 0); }, true},
    {"sendto",
     [](int fd, char* text, std::size_t size) { return sendto(fd, text, size, 0, nullptr, 0); },
     true},
    {"sendmsg",
     [](int fd, char* text, std::size_t size) {
       iovec iov{text, size};
       const msghdr message = MessageOf(iov);
       return sendmsg(fd, &message, 0);
     },
     true},
    {"sendmmsg",
     [](int fd, char* text, std::size_t size) {
       iovec iov{text, size};
       mmsghdr several{};
       several.msg_hdr = MessageOf(iov);
       const int sent = sendmmsg(fd, &several, 1, 0);
       return sent == 1 ? long{several.msg_len} : long{sent};
     },
     true},
    {"raw sendto",
     [](int fd, char* text, std::size_t size) {
       return syscall(SYS_sendto, fd, text, size, 0, 0, 0);
     },
     true},
    {"raw sendmsg",
     [](int fd, char* text, std::size_t size) {
       iovec iov{text, size};
       const msghdr message = MessageOf(iov);
       return syscall(SYS_sendmsg, fd, &message, 0);
     },
     true},
    {"raw sendmmsg",
     [](int fd, char* text, std::size_t size) {
       iovec iov{text, size};
       mmsghdr several{};
       several.msg_hdr = MessageOf(iov);
       const long sent = syscall(SYS_sendmmsg, fd, &several, 1, 0);
       return sent == 1 ? long{several.msg_len} : sent;
     },
     true},
};

void Writes(Kind kind, const Writer& writer, Fate fate) {
  int ends[2];
  MakePair(kind, ends);
  const bool is_raw = strncmp(writer.name, "raw", 3) == 0;
  std::vector<char> text = Much(), found(kMuch);
  // The kernel carries raw calls out in one piece, for which there has to be room.
  const std::size_t size = is_raw ? 1000 : kMuch;
  const Other other(false);
  std::size_t filled = 0;
  fcntl(ends[1], F_SETFL, O_NONBLOCK);
  while (is_raw) {
    const ssize_t n = write(ends[1], text.data(), 1000);
    if (n < 0) break;
    filled += static_cast<std::size_t>(n);
  }
  fcntl(ends[1], F_SETFL, 0);
  const auto read_all = [&](char* to, std::size_t count) {
    for (std::size_t got = 0; got < count;) {
      const ssize_t n = read(ends[0], to + got, count - got);
      EXPECT(n > 0, "%s: %zd read (%s)", g_what.c_str(), n, strerror(errno));
      got += static_cast<std::size_t>(n);
    }
  };
  Meanwhile(
      fate, ends[1], other.end(1),
      [&] {
        const long sent = writer.write(ends[1], text.data(), size);
        EXPECT(sent == static_cast<long>(size), "%s: %ld (%s)", g_what.c_str(), sent,
               strerror(errno));
      },
      [&] {
        std::vector<char> before(filled);
        read_all(before.data(), filled);
        read_all(found.data(), size);
      });
  EXPECT(memcmp(text.data(), found.data(), size) == 0, "%s: other bytes", g_what.c_str());
  // With the call the last end for writing is gone.
  char c;
  EXPECT(read(ends[0], &c, 1) == 0, "%s: no end of file", g_what.c_str());
  CloseIfOpen(fate, ends[1]);
  close(ends[0]);
}

void AllWrites(Fate fate) {
  for (const Writer& writer : kWriters) {
    for (const Kind kind : {Kind::kPipe, Kind::kStream}) {
      if (writer.of_sockets && kind == Kind::kPipe) continue;
      g_what = writer.name + std::string(kind == Kind::kPipe ? " to a pipe" : " to a stream") +
               NameOf(fate);
      Writes(kind, writer, fate);
    }
  }
}

// ---- Connections.

sockaddr_un LocalAddress(socklen_t* size) {
  static int count = 0;
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const int length = snprintf(address.sun_path + 1, sizeof address.sun_path - 1, "tcs-closed-%d-%d",
                              getpid(), ++count);
  *size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + length);
  return address;
}

void Accepts(Fate fate, bool raw) {
  g_what = std::string(raw ? "raw " : "") + "accept" + NameOf(fate);
  socklen_t size = 0;
  sockaddr_un address = LocalAddress(&size);
  auto* const to = reinterpret_cast<sockaddr*>(&address);
  const int listener = socket(AF_UNIX, SOCK_STREAM, 0);
  EXPECT(bind(listener, to, size) == 0 && listen(listener, 2) == 0, "listen");
  const Other other(true);
  int client = -1;
  long connection = -1;
  Meanwhile(
      fate, listener, other.end(0),
      [&] {
        connection = raw ? syscall(SYS_accept, listener, nullptr, nullptr)
                         : accept(listener, nullptr, nullptr);
        EXPECT(connection >= 0, "%s: %s", g_what.c_str(), strerror(errno));
      },
      [&] {
        client = socket(AF_UNIX, SOCK_STREAM, 0);
        EXPECT(connect(client, to, size) == 0, "%s: connect: %s", g_what.c_str(), strerror(errno));
      });
  char text[4] = {};
  EXPECT(write(client, "abc", 3) == 3 && read(static_cast<int>(connection), text, 3) == 3 &&
             strcmp(text, "abc") == 0,
         "%s: another connection", g_what.c_str());
  const int next = socket(AF_UNIX, SOCK_STREAM, 0);
  EXPECT(connect(next, to, size) == -1 && errno == ECONNREFUSED, "%s: still there", g_what.c_str());
  close(next);
  close(client);
  close(static_cast<int>(connection));
  CloseIfOpen(fate, listener);
}

// A connection waits for room in the listener's queue.
void Connects(Fate fate) {
  g_what = "connect" + NameOf(fate);
  socklen_t size = 0;
  sockaddr_un address = LocalAddress(&size);
  auto* const to = reinterpret_cast<sockaddr*>(&address);
  const int listener = socket(AF_UNIX, SOCK_STREAM, 0);
  EXPECT(bind(listener, to, size) == 0 && listen(listener, 0) == 0, "listen");
  const int first = socket(AF_UNIX, SOCK_STREAM, 0);
  EXPECT(connect(first, to, size) == 0, "connect");
  const int waiting = socket(AF_UNIX, SOCK_STREAM, 0), other = socket(AF_UNIX, SOCK_STREAM, 0);
  int accepted = -1;
  Meanwhile(
      fate, waiting, other,
      [&] { EXPECT(connect(waiting, to, size) == 0, "%s: %s", g_what.c_str(), strerror(errno)); },
      [&] { accepted = accept(listener, nullptr, nullptr); });
  const int second = accept(listener, nullptr, nullptr);
  char c;
  // It was the connection's last descriptor.
  EXPECT(read(second, &c, 1) == 0, "%s: no end of file", g_what.c_str());
  EXPECT(write(other, "x", 1) == -1 && errno == ENOTCONN, "%s: another was connected",
         g_what.c_str());
  CloseIfOpen(fate, waiting);
  for (const int fd : {listener, first, other, accepted, second}) close(fd);
}

// ---- What the kernel moves by itself.

void Splices(Fate fate) {
  g_what = "splice from a pipe" + NameOf(fate);
  int from[2], to[2];
  EXPECT(pipe(from) == 0 && pipe(to) == 0, "pipe");
  {
    const Other other(true);
    Meanwhile(
        fate, from[0], other.end(0),
        [&] {
          EXPECT(splice(from[0], nullptr, to[1], nullptr, kSize, 0) == kSize, "%s: %s",
                 g_what.c_str(), strerror(errno));
        },
        [&] { EXPECT(write(from[1], kText, kSize) == kSize, "write"); });
  }
  ExpectClosed(Kind::kPipe, from[1]);
  CloseIfOpen(fate, from[0]);
  close(from[1]);
  // To a pipe without room.
  g_what = "sendfile to a pipe" + NameOf(fate);
  char path[] = "/tmp/tcs_closed_XXXXXX";
  const int file = mkstemp(path);
  EXPECT(file >= 0, "mkstemp");
  unlink(path);
  EXPECT(write(file, kText, kSize) == kSize, "write");
  off_t at = 0;
  std::vector<char> text(1 << 16);
  const int room = fcntl(to[1], F_GETPIPE_SZ);
  char before[kSize];
  EXPECT(read(to[0], before, kSize) == kSize, "read");
  EXPECT(write(to[1], text.data(), static_cast<std::size_t>(room)) == room, "write");
  {
    const Other other(false);
    Meanwhile(
        fate, to[1], other.end(1),
        [&] {
          EXPECT(sendfile(to[1], file, &at, kSize) == kSize, "%s: %s", g_what.c_str(),
                 strerror(errno));
        },
        [&] { EXPECT(read(to[0], text.data(), static_cast<std::size_t>(room)) == room, "read"); });
  }
  char after[kSize + 1] = {};
  EXPECT(read(to[0], after, kSize) == kSize && strcmp(after, kText) == 0, "%s: '%s'",
         g_what.c_str(), after);
  EXPECT(read(to[0], after, 1) == 0, "%s: no end of file", g_what.c_str());
  CloseIfOpen(fate, to[1]);
  for (const int fd : {to[0], file}) close(fd);
}

// ---- Polls.

struct Poller {
  const char* name;
  // The events that are found, as poll has them; 0: none until the timeout.
  std::function<int(int fd, int timeout_ms)> poll;
};

int ByPoll(bool raw, int fd, int timeout_ms) {
  pollfd looked_at{fd, POLLIN, 0};
  const long n =
      raw ? syscall(SYS_poll, &looked_at, 1, timeout_ms) : poll(&looked_at, 1, timeout_ms);
  EXPECT(n == (looked_at.revents != 0), "%s: %ld", g_what.c_str(), n);
  return looked_at.revents;
}

int BySelect(bool raw, int fd, int timeout_ms) {
  fd_set set;
  FD_ZERO(&set);
  FD_SET(fd, &set);
  timeval timeout{timeout_ms / 1000, timeout_ms % 1000 * 1000};
  const long n = raw ? syscall(SYS_select, fd + 1, &set, nullptr, nullptr, &timeout)
                     : select(fd + 1, &set, nullptr, nullptr, &timeout);
  EXPECT(n >= 0, "%s: %s", g_what.c_str(), strerror(errno));
  EXPECT(n == FD_ISSET(fd, &set), "%s: %ld", g_what.c_str(), n);
  return n == 0 ? 0 : POLLIN;
}

const Poller kPollers[] = {
    {"poll", [](int fd, int timeout_ms) { return ByPoll(false, fd, timeout_ms); }},
    {"raw poll", [](int fd, int timeout_ms) { return ByPoll(true, fd, timeout_ms); }},
    {"select", [](int fd, int timeout_ms) { return BySelect(false, fd, timeout_ms); }},
    {"raw select", [](int fd, int timeout_ms) { return BySelect(true, fd, timeout_ms); }},
};

// Something comes in the file, and 20 ms later in what has its number.
void Polls(const Poller& poller, Fate fate, bool is_full) {
  const bool selects = strstr(poller.name, "select") != nullptr;
  g_what = poller.name + NameOf(fate) + (is_full ? ", with something there" : "");
  int ends[2], other[2];
  MakePair(Kind::kPipe, ends);
  MakePair(Kind::kPipe, other);
  if (is_full) EXPECT(write(other[1], "x", 1) == 1, "write");
  constexpr int kTimeoutMs = 300;
  // It looks again when woken, and at the end: woken by the file, and not by the other.
  const bool at_once = is_full || fate == Fate::kClosed;
  int found = -1;
  const pid_t caller = gettid();
  Meanwhile(
      fate, ends[0], other[0], [&] { found = poller.poll(ends[0], kTimeoutMs); },
      [&] {
        EXPECT(write(ends[1], "x", 1) == 1, "write");
        usleep(20'000);
        NativelyUntil([&] { return Sleeps(caller); });  // it has looked
        EXPECT(write(other[1], "x", 1) == 1, "write");
      },
      at_once ? kComesAfter : kTimeoutMs * kMs);
  const int wanted = fate == Fate::kClosed && !selects ? POLLNVAL : POLLIN;
  EXPECT(found == wanted, "%s: events %x", g_what.c_str(), found);
  CloseIfOpen(fate, ends[0]);
  for (const int fd : {ends[1], other[0], other[1]}) close(fd);
}

void Sets(Fate fate, bool raw) {
  int ends[2];
  MakePair(Kind::kPipe, ends);
  const auto wait = [raw](int set, epoll_event* event, int timeout_ms) {
    return raw ? syscall(SYS_epoll_wait, set, event, 1, timeout_ms)
               : epoll_wait(set, event, 1, timeout_ms);
  };
  const std::string call = raw ? "raw epoll_wait" : "epoll_wait";
  const int set = epoll_create1(0), other_set = epoll_create1(0);
  epoll_event event{};
  event.events = EPOLLIN;
  event.data.u64 = 17;
  EXPECT(epoll_ctl(set, EPOLL_CTL_ADD, ends[0], &event) == 0, "epoll_ctl");
  g_what = call + NameOf(fate);
  Meanwhile(
      fate, set, other_set,
      [&] {
        epoll_event found{};
        const long n = wait(set, &found, 1000);
        EXPECT(n == 1 && found.data.u64 == 17, "%s: %ld (%s)", g_what.c_str(), n, strerror(errno));
      },
      [&] { EXPECT(write(ends[1], "x", 1) == 1, "write"); });
  CloseIfOpen(fate, set);
  close(other_set);
  // What is in the set, in which it is no more once nobody else has it.
  g_what = call + " of one" + NameOf(fate);
  const int second = epoll_create1(0);
  EXPECT(epoll_ctl(second, EPOLL_CTL_ADD, ends[0], &event) == 0, "epoll_ctl");
  char c;
  EXPECT(read(ends[0], &c, 1) == 1, "read");
  const Other other(true);
  Meanwhile(
      fate, ends[0], other.end(0),
      [&] {
        epoll_event found{};
        EXPECT(wait(second, &found, 200) == 0, "%s", g_what.c_str());
      },
      [&] { EXPECT(write(ends[1], "x", 1) == -1 && errno == EPIPE, "%s", g_what.c_str()); },
      200 * kMs);
  CloseIfOpen(fate, ends[0]);
  close(second);
  close(ends[1]);
}

// ---- Message queues, which are descriptors, too.

void Queues(Fate fate) {
  char name[32];
  snprintf(name, sizeof name, "/tcs-closed-%d", getpid());
  mq_attr attributes{};
  attributes.mq_maxmsg = 1;
  attributes.mq_msgsize = 16;
  const mqd_t queue = mq_open(name, O_CREAT | O_RDWR, 0600, &attributes);
  const mqd_t opposite = mq_open(name, O_RDWR);
  EXPECT(queue >= 0 && opposite >= 0, "mq_open: %s", strerror(errno));
  mq_unlink(name);
  const Other other(true);
  char text[16] = {};
  g_what = "mq_receive" + NameOf(fate);
  Meanwhile(
      fate, queue, other.end(0),
      [&] {
        EXPECT(mq_receive(queue, text, sizeof text, nullptr) == 3, "%s: %s", g_what.c_str(),
               strerror(errno));
      },
      [&] { EXPECT(mq_send(opposite, "abc", 3, 0) == 0, "mq_send"); });
  CloseIfOpen(fate, queue);
  const mqd_t full = dup(opposite);
  EXPECT(mq_send(full, "first", 5, 0) == 0, "mq_send");
  g_what = "mq_send" + NameOf(fate);
  Meanwhile(
      fate, full, other.end(0),
      [&] {
        EXPECT(mq_send(full, "second", 6, 0) == 0, "%s: %s", g_what.c_str(), strerror(errno));
      },
      [&] { EXPECT(mq_receive(opposite, text, sizeof text, nullptr) == 5, "mq_receive"); });
  EXPECT(mq_receive(opposite, text, sizeof text, nullptr) == 6, "mq_receive");
  CloseIfOpen(fate, full);
  close(opposite);
}

// ---- What goes with it.

// A child that is made meanwhile has no copy of what is closed: the file ends with the call.
void Forks(Fate fate) {
  g_what = "a child beside read" + NameOf(fate);
  int ends[2];
  MakePair(Kind::kPipe, ends);
  const Other other(true);
  pid_t child = 0;
  char text[kSize + 1] = {};
  Meanwhile(
      fate, ends[0], other.end(0),
      [&] {
        EXPECT(read(ends[0], text, kSize) == kSize, "%s: %s", g_what.c_str(), strerror(errno));
      },
      [&] {
        child = fork();
        if (child == 0) {
          usleep(200'000);
          _exit(0);
        }
        EXPECT(write(ends[1], kText, kSize) == kSize, "write");
      });
  ExpectClosed(Kind::kPipe, ends[1]);
  int status = -1;
  EXPECT(waitpid(child, &status, 0) == child && status == 0, "child: %x", status);
  CloseIfOpen(fate, ends[0]);
  close(ends[1]);
}

// The kernel makes a call again after a signal, by its number.
void Interrupted(Fate fate) {
  g_what = "read after a signal" + NameOf(fate);
  struct sigaction action {};
  action.sa_handler = [](int) {};
  action.sa_flags = SA_RESTART;
  EXPECT(sigaction(SIGUSR1, &action, nullptr) == 0, "sigaction");
  int ends[2], other[2];
  MakePair(Kind::kPipe, ends);
  MakePair(Kind::kPipe, other);
  EXPECT(write(other[1], kText, kSize) == kSize, "write");
  const pthread_t caller = pthread_self();
  char text[kSize + 1] = {};
  Meanwhile(
      fate, ends[0], other[0],
      [&] {
        const ssize_t got = read(ends[0], text, kSize);
        EXPECT(fate == Fate::kClosed ? got == -1 && errno == EBADF
                                     : got == kSize && strcmp(text, kText) == 0,
               "%s: %zd (%s)", g_what.c_str(), got, strerror(errno));
      },
      [&] { pthread_kill(caller, SIGUSR1); });
  CloseIfOpen(fate, ends[0]);
  for (const int fd : {ends[1], other[0], other[1]}) close(fd);
}

// A timeout is that of the file, and over with nothing of what has the number.
void Timeouts(Fate fate) {
  for (const bool raw : {false, true}) {
    g_what = std::string(raw ? "raw read" : "recv") + " with a timeout" + NameOf(fate);
    int ends[2];
    MakePair(Kind::kStream, ends);
    const Other other(true);
    const timeval timeout{0, 60'000};
    EXPECT(setsockopt(ends[0], SOL_SOCKET, SO_RCVTIMEO, &timeout, sizeof timeout) == 0,
           "setsockopt");
    char text[kSize];
    Meanwhile(
        fate, ends[0], other.end(0),
        [&] {
          const long got =
              raw ? syscall(SYS_read, ends[0], text, kSize) : recv(ends[0], text, kSize, 0);
          EXPECT(got == -1 && errno == EAGAIN, "%s: %ld (%s)", g_what.c_str(), got,
                 strerror(errno));
        },
        [] {}, g_mode == Mode::kNative ? 50 * kMs : 60 * kMs);
    ExpectClosed(Kind::kStream, ends[1]);
    CloseIfOpen(fate, ends[0]);
    close(ends[1]);
  }
}

// Several threads wait in turn for the same file: what one leaves the next one gets.
void Several(Fate fate) {
  g_what = "three readers of one" + NameOf(fate);
  int ends[2];
  MakePair(Kind::kDatagram, ends);
  const Other other(true);
  std::vector<std::thread> readers;
  std::atomic<int> total{0};
  std::atomic<pid_t> tids[2] = {{0}, {0}};
  for (std::atomic<pid_t>& tid : tids) {
    readers.emplace_back([&] {
      char text[kSize];
      tid = gettid();
      EXPECT(read(ends[0], text, kSize) == 1, "%s: %s", g_what.c_str(), strerror(errno));
      total += text[0];
    });
    NativelyUntil([&] { return tid != 0 && Sleeps(tid); });
  }
  Meanwhile(
      fate, ends[0], other.end(0),
      [&] {
        char text[kSize];
        EXPECT(read(ends[0], text, kSize) == 1, "%s: %s", g_what.c_str(), strerror(errno));
        total += text[0];
        for (std::thread& reader : readers) reader.join();
      },
      [&] {
        for (const char* c : {"\1", "\2", "\4"}) EXPECT(write(ends[1], c, 1) == 1, "write");
      });
  EXPECT(total == 7, "%s: %d", g_what.c_str(), total.load());
  ExpectClosed(Kind::kDatagram, ends[1]);
  CloseIfOpen(fate, ends[0]);
  close(ends[1]);
}

}  // namespace

int main(int argc, char** argv) {
  signal(SIGPIPE, SIG_IGN);
  Begin(argc, argv);
  using Part = std::function<void(Fate)>;
  const Part parts[] = {AllReads,
                        EndsOfFile,
                        AllOfIt,
                        Counters,
                        Timers,
                        Signals,
                        Terminals,
                        AllWrites,
                        [](Fate fate) {
                          Accepts(fate, false);
                          Accepts(fate, true);
                        },
                        Connects,
                        Splices,
                        [](Fate fate) {
                          for (const Poller& poller : kPollers) {
                            Polls(poller, fate, false);
                            Polls(poller, fate, true);
                          }
                        },
                        [](Fate fate) {
                          Sets(fate, false);
                          Sets(fate, true);
                        },
                        Queues,
                        Forks,
                        Interrupted,
                        Timeouts,
                        Several};
  ForEachAtOnceNatively(parts, [](const Part& part) {
    for (const Fate fate : kFates) part(fate);
  });
}
