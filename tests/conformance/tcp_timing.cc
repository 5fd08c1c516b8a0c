// TCP on one machine: what is written is there for the reader at once, whatever the kernel's own
// timers would wait for: acknowledgements (40 ms), corks (200 ms), connections tried again (1 s).
#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/tcp.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/wait.h>

#include <vector>

#include "tests/conformance/other_process.h"

using namespace conformance;

namespace {

bool IsNative() { return g_mode == Mode::kNative; }

// Natively the kernel's timers, and other programs, may have their say.
std::int64_t MostLate() { return IsNative() ? 10 * kSecond : 5 * kMs; }
std::int64_t Gap() { return IsNative() ? 5 * kMs : 5 * kSecond; }

// What a child's start costs does not count: it waits by then for what comes.
void AwaitTheOther() { usleep(100'000); }

int Listen(int backlog) {
  const int listener = socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  EXPECT(bind(listener, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0, "%s",
         strerror(errno));
  EXPECT(listen(listener, backlog) == 0, "%s", strerror(errno));
  return listener;
}

int Connect(int listener) {
  sockaddr_in address{};
  socklen_t size = sizeof address;
  EXPECT(getsockname(listener, reinterpret_cast<sockaddr*>(&address), &size) == 0, "getsockname");
  const int fd = socket(AF_INET, SOCK_STREAM, 0);
  EXPECT(connect(fd, reinterpret_cast<sockaddr*>(&address), size) == 0, "%s", strerror(errno));
  return fd;
}

struct Pair {
  int here, there;
};

Pair Connected() {
  const int listener = Listen(1);
  const int here = Connect(listener);
  const int there = accept(listener, nullptr, nullptr);
  EXPECT(there >= 0, "%s", strerror(errno));
  close(listener);
  return {here, there};
}

void Put(int fd, std::int64_t value) {
  EXPECT(write(fd, &value, sizeof value) == sizeof value, "%s", strerror(errno));
}

std::int64_t Take(int fd) {
  std::int64_t value = 0;
  EXPECT(recv(fd, &value, sizeof value, MSG_WAITALL) == sizeof value, "%s", strerror(errno));
  return value;
}

void ExpectJustSent(std::int64_t sent, const char* what) {
  const std::int64_t late = Now() - sent;
  EXPECT(late >= 0 && late < MostLate(), "%s: seen after %lld ns", what, (long long)late);
}

// A reader that answers, so that it keeps its acknowledgements for the answers; then a writer that
// only writes, twice in a row each time.
void SmallMessagesAreSeenAtOnce(bool by_stdio) {
  const Pair pair = Connected();
  const pid_t reader = Start([&] {
    FILE* file = fdopen(pair.there, "r");
    auto take = [&] {
      if (!by_stdio) return Take(pair.there);
      std::int64_t value = 0;
      EXPECT(fread(&value, sizeof value, 1, file) == 1, "fread");
      return value;
    };
    for (int i = 0; i < 3; ++i) {
      ExpectJustSent(take(), "a question");
      Put(pair.there, Now());
    }
    for (int i = 0; i < 40; ++i) ExpectJustSent(take(), "a message");
  });
  AwaitTheOther();
  for (int i = 0; i < 3; ++i) {
    Put(pair.here, Now());
    ExpectJustSent(Take(pair.here), "an answer");
  }
  for (int i = 0; i < 20; ++i) {
    usleep(static_cast<useconds_t>(Gap() / 1000));
    Put(pair.here, Now());
    Put(pair.here, Now());
  }
  ExpectWell(reader);
  close(pair.here);
  close(pair.there);
}

// More than a connection sends without hearing from the other end; all of it is there for who looks
// later.
void AllIsThereForALateReader() {
  const Pair pair = Connected();
  constexpr int kCount = 25;
  int done[2];
  EXPECT(pipe(done) == 0, "pipe");
  const pid_t writer = Start([&] {
    for (int i = 0; i < kCount; ++i) {
      Put(pair.here, Now());
      usleep(1000);
    }
    EXPECT(write(done[1], "x", 1) == 1, "%s", strerror(errno));
    pause();
  });
  char byte;
  EXPECT(read(done[0], &byte, 1) == 1, "%s", strerror(errno));
  // Natively the kernel's acknowledgements are given time; here they get none.
  usleep(300'000);
  EXPECT(fcntl(pair.there, F_SETFL, O_NONBLOCK) == 0, "fcntl");
  std::int64_t value = 0, last = 0;
  int count = 0;
  while (recv(pair.there, &value, sizeof value, 0) == sizeof value) {
    EXPECT(value > last && value < Now(), "sent at %lld", (long long)value);
    last = value;
    ++count;
  }
  EXPECT(count == kCount && errno == EAGAIN, "%d of %d were there", count, kCount);
  kill(writer, SIGKILL);
  EXPECT(waitpid(writer, nullptr, 0) == writer, "waitpid");
  for (const int fd : {pair.here, pair.there, done[0], done[1]}) close(fd);
}

int Option(int fd, int option) {
  int value = -1;
  socklen_t size = sizeof value;
  EXPECT(getsockopt(fd, IPPROTO_TCP, option, &value, &size) == 0 && size == sizeof value, "%s",
         strerror(errno));
  return value;
}

void Set(int fd, int option, int value) {
  EXPECT(setsockopt(fd, IPPROTO_TCP, option, &value, sizeof value) == 0, "%s", strerror(errno));
}

// What the program asks for is what it is told, on what a listener accepts and in a child, too.
void WishesAreRemembered() {
  for (const int option : {TCP_NODELAY, TCP_CORK}) {
    const int listener = Listen(8);
    EXPECT(Option(listener, option) == 0, "option %d is set from the start", option);
    const int plain = Connect(listener);
    EXPECT(Option(plain, option) == 0, "option %d is set from the start", option);
    const int plain_there = accept(listener, nullptr, nullptr);
    EXPECT(Option(plain_there, option) == 0, "option %d is set on what was accepted", option);
    Set(listener, option, 1);
    const int other = Connect(listener);
    const int other_there = accept(listener, nullptr, nullptr);
    EXPECT(Option(other_there, option) == 1, "option %d is not inherited", option);
    Set(plain, option, 5);
    EXPECT(Option(plain, option) == 1 && Option(plain_there, option) == 0, "option %d", option);
    ExpectWell(Start([&] {
      EXPECT(Option(plain, option) == 1, "option %d in a child", option);
      Set(plain, option, 0);
    }));
    EXPECT(Option(plain, option) == 0, "option %d, taken back by the child", option);
    char small = 0;
    EXPECT(setsockopt(plain, IPPROTO_TCP, option, &small, 1) == -1 && errno == EINVAL, "size");
    for (const int fd : {listener, plain, plain_there, other, other_there}) close(fd);
  }
}

// Long enough for what waits for a timer of the kernel's to be late in virtual time.
void LetTimePass() { usleep(static_cast<useconds_t>(60 * Gap() / 1000)); }

// Nobody ever takes the cork out: the kernel gives up after 200 ms.
void CorksHoldNothingBackForLong() {
  const Pair pair = Connected();
  Set(pair.here, TCP_CORK, 1);
  const pid_t reader = Start([&] { ExpectJustSent(Take(pair.there), "what was corked"); });
  AwaitTheOther();
  Put(pair.here, Now());
  LetTimePass();
  ExpectWell(reader);
  Set(pair.here, TCP_CORK, 0);
  const pid_t other = Start([&] { ExpectJustSent(Take(pair.there), "what more was said of"); });
  AwaitTheOther();
  const std::int64_t now = Now();
  EXPECT(send(pair.here, &now, sizeof now, MSG_MORE) == sizeof now, "%s", strerror(errno));
  LetTimePass();
  ExpectWell(other);
  close(pair.here);
  close(pair.there);
}

// More connections than the listener keeps: natively they wait until some are accepted, and then a
// second or three longer.
void ConnectionsAreMadeThoughNobodyAcceptsYet() {
  const int listener = Listen(1);
  constexpr int kCount = 5;
  const std::int64_t start = Now();
  const pid_t client = Start([&] {
    for (int i = 0; i < kCount; ++i) Put(Connect(listener), Now());
    pause();
  });
  usleep(200'000);
  std::vector<int> accepted;
  for (int i = 0; i < kCount; ++i) {
    accepted.push_back(accept(listener, nullptr, nullptr));
    const std::int64_t sent = Take(accepted.back());
    EXPECT(sent >= start && sent <= start + (IsNative() ? 20 * kSecond : MostOfChildren()),
           "connected after %lld ns", (long long)(sent - start));
  }
  kill(client, SIGKILL);
  EXPECT(waitpid(client, nullptr, 0) == client, "waitpid");
  for (const int fd : accepted) close(fd);
  close(listener);
}

// A writer that has filled all buffers goes on when the reader makes room.
void RoomIsFoundWhenItIsMade() {
  const Pair pair = Connected();
  const std::int64_t start = Now();
  const std::int64_t pause_ns = 20 * Gap();
  constexpr std::size_t kAll = 32 << 20;
  const pid_t reader = Start([&] {
    usleep(static_cast<useconds_t>(pause_ns / 1000));
    std::vector<char> buffer(1 << 16);
    for (std::size_t got = 0; got < kAll;) {
      const ssize_t n = read(pair.there, buffer.data(), buffer.size());
      EXPECT(n > 0, "%s", strerror(errno));
      got += static_cast<std::size_t>(n);
    }
    Put(pair.there, Now());
  });
  const std::vector<char> data(kAll);
  EXPECT(write(pair.here, data.data(), kAll) == static_cast<ssize_t>(kAll), "%s", strerror(errno));
  const std::int64_t written = Now();
  const std::int64_t read_at = Take(pair.here);
  EXPECT(written - start >= pause_ns, "all was taken by nobody");
  EXPECT(written - read_at < MostLate(), "%lld ns after the reader",
         (long long)(written - read_at));
  EXPECT(read_at - start < pause_ns + (IsNative() ? 5 * kSecond : 500 * kMs), "read after %lld ns",
         (long long)(read_at - start));
  ExpectWell(reader);
  close(pair.here);
  close(pair.there);
}

}  // namespace

int main(int argc, char** argv) {
  Begin(argc, argv);
  for (const bool by_stdio : {false, true}) SmallMessagesAreSeenAtOnce(by_stdio);
  AllIsThereForALateReader();
  WishesAreRemembered();
  CorksHoldNothingBackForLong();
  ConnectionsAreMadeThoughNobodyAcceptsYet();
  RoomIsFoundWhenItIsMade();
}
