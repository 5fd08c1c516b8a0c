// Closing a TCP socket that lingers (SO_LINGER): it takes until the other end has room for all that
// was written, and the time to linger at most.
#include <arpa/inet.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/time.h>

#include <vector>

#include "tests/conformance/other_process.h"

using namespace conformance;

namespace {

struct Pair {
  int here, there;
};

// What a listener accepts inherits it from there.
enum class LingersFrom { kListener, kSocket };

void Linger(int fd, int seconds) {
  const linger value{1, seconds};
  EXPECT(setsockopt(fd, SOL_SOCKET, SO_LINGER, &value, sizeof value) == 0, "%s", strerror(errno));
}

// `here` lingers.
Pair Connected(int seconds, LingersFrom lingers_from = LingersFrom::kSocket) {
  const int listener = socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  auto* generic = reinterpret_cast<sockaddr*>(&address);
  EXPECT(bind(listener, generic, size) == 0 && listen(listener, 1) == 0 &&
             getsockname(listener, generic, &size) == 0,
         "%s", strerror(errno));
  if (lingers_from == LingersFrom::kListener) Linger(listener, seconds);
  const int there = socket(AF_INET, SOCK_STREAM, 0);
  EXPECT(connect(there, generic, size) == 0, "%s", strerror(errno));
  const int here = accept(listener, nullptr, nullptr);
  EXPECT(here >= 0, "%s", strerror(errno));
  if (lingers_from == LingersFrom::kSocket) Linger(here, seconds);
  // The listener itself, which is connected to nobody, is closed at once.
  EXPECT(close(listener) == 0, "%s", strerror(errno));
  return {here, there};
}

void Fill(int fd) {
  const std::vector<char> data(1 << 16);
  while (send(fd, data.data(), data.size(), MSG_DONTWAIT) > 0) {
  }
  EXPECT(errno == EAGAIN, "%s", strerror(errno));
}

// Closes, or has another file put in its place.
void Close(int fd) { EXPECT(close(fd) == 0, "%s", strerror(errno)); }

// Natively the kernel's timers have their say, too.
void ExpectTook(std::int64_t start, std::int64_t wanted_ns, const char* what) {
  const std::int64_t passed = Now() - start;
  // Where it is measured, what megabytes cost the one who reads them is the host's.
  const std::int64_t slack_ns = g_mode == Mode::kNative  ? 5 * kSecond
                                : g_mode == Mode::kFixed ? 5 * kMs
                                                         : 80 * kMs;
  const std::int64_t tick_ns = g_mode == Mode::kNative ? 10 * kMs : 0;
  EXPECT(passed >= wanted_ns - tick_ns && passed < wanted_ns + slack_ns, "%s took %lld ns", what,
         (long long)passed);
}

// The other end's kernel has all of it, though no program has read it.
void WhatIsSentNeedsNoWait() {
  const Pair pair = Connected(60);
  EXPECT(send(pair.here, "x", 1, 0) == 1, "%s", strerror(errno));
  const std::int64_t start = Now();
  Close(pair.here);
  ExpectTook(start, 0, "closing what has been sent");
  char byte = 0;
  EXPECT(recv(pair.there, &byte, 1, 0) == 1 && byte == 'x', "%s", strerror(errno));
  EXPECT(recv(pair.there, &byte, 1, 0) == 0, "no end of file");
  Close(pair.there);
}

void NobodyReads(LingersFrom lingers_from, bool is_replaced, bool is_shut_down) {
  const Pair pair = Connected(1, lingers_from);
  Fill(pair.here);
  if (is_shut_down) EXPECT(shutdown(pair.here, SHUT_WR) == 0, "%s", strerror(errno));
  const std::int64_t start = Now();
  if (is_replaced) {
    EXPECT(dup2(STDERR_FILENO, pair.here) == pair.here, "%s", strerror(errno));
  } else {
    Close(pair.here);
  }
  if (g_mode == Mode::kFixed) {
    ExpectWaited(start, kSecond, 2, "closing what nobody reads");
  } else {
    ExpectTook(start, kSecond, "closing what nobody reads");
  }
  if (is_replaced) Close(pair.here);
  Close(pair.there);
}

// The child tells that it has closed its own descriptor, which is not the last one: at once.
class Told {
 public:
  Told() { EXPECT(pipe(ends_) == 0, "pipe"); }
  ~Told() {
    for (const int end : ends_) close(end);
  }
  void Tell() { EXPECT(write(ends_[1], "x", 1) == 1, "%s", strerror(errno)); }
  void Await() {
    char byte;
    EXPECT(read(ends_[0], &byte, 1) == 1, "%s", strerror(errno));
  }

 private:
  int ends_[2];
};

void TheReaderEndsTheWait() {
  const Pair pair = Connected(60);
  Fill(pair.here);
  Told has_closed;
  const std::int64_t start = Now();
  const pid_t reader = Start([&] {
    Close(pair.here);
    has_closed.Tell();
    usleep(300'000);
    std::vector<char> buffer(1 << 16);
    while (recv(pair.there, buffer.data(), buffer.size(), 0) > 0) {
    }
  });
  Close(pair.there);
  has_closed.Await();
  Close(pair.here);
  ExpectTook(start, 300 * kMs, "closing what is read after 300 ms");
  ExpectWell(reader);
}

void AResetEndsTheWait() {
  const Pair pair = Connected(60);
  Fill(pair.here);
  Told has_closed;
  const std::int64_t start = Now();
  const pid_t other = Start([&] {
    Close(pair.here);
    has_closed.Tell();
    usleep(300'000);
    Close(pair.there);  // with what it has not read
  });
  Close(pair.there);
  has_closed.Await();
  Close(pair.here);
  ExpectTook(start, 300 * kMs, "closing what is reset after 300 ms");
  ExpectWell(other);
}

void OnlyTheLastDescriptorLingers() {
  const Pair pair = Connected(1);
  Fill(pair.here);
  const int copy = dup(pair.here);
  std::int64_t start = Now();
  Close(pair.here);
  ExpectTook(start, 0, "closing one of two descriptors");
  start = Now();
  Close(copy);
  ExpectTook(start, kSecond, "closing the last descriptor");
  Close(pair.there);
}

void ASignalEndsTheWait() {
  struct sigaction action {};
  action.sa_handler = [](int) {};
  sigaction(SIGALRM, &action, nullptr);
  const Pair pair = Connected(60);
  Fill(pair.here);
  const std::int64_t start = Now();
  const itimerval timer{{0, 0}, {0, 300'000}};
  EXPECT(setitimer(ITIMER_REAL, &timer, nullptr) == 0, "%s", strerror(errno));
  Close(pair.here);
  ExpectTook(start, 300 * kMs, "closing what a signal ends");
  EXPECT(send(pair.here, "", 1, 0) == -1 && errno == EBADF, "it is not closed");
  Close(pair.there);
}

// To linger for no time is to reset.
void NoTimeResets() {
  const Pair pair = Connected(0);
  Fill(pair.here);
  const std::int64_t start = Now();
  Close(pair.here);
  ExpectTook(start, 0, "resetting");
  EXPECT(send(pair.there, "x", 1, MSG_NOSIGNAL) == -1 && errno == ECONNRESET, "%s",
         strerror(errno));
  Close(pair.there);
}

template <class Case>
void Try(std::vector<pid_t>& beside, Case each) {
  if (g_mode == Mode::kNative) {
    beside.push_back(Start(each));
  } else {
    each();
  }
}

}  // namespace

// Natively all at once, for each takes a second or two.
int main(int argc, char** argv) {
  Begin(argc, argv);
  std::vector<pid_t> beside;
  Try(beside, NoTimeResets);
  Try(beside, WhatIsSentNeedsNoWait);
  for (const LingersFrom from : {LingersFrom::kListener, LingersFrom::kSocket}) {
    Try(beside, [from] { NobodyReads(from, false, false); });
  }
  Try(beside, [] { NobodyReads(LingersFrom::kSocket, true, false); });
  Try(beside, [] { NobodyReads(LingersFrom::kSocket, false, true); });
  Try(beside, TheReaderEndsTheWait);
  Try(beside, AResetEndsTheWait);
  Try(beside, OnlyTheLastDescriptorLingers);
  Try(beside, ASignalEndsTheWait);
  for (const pid_t pid : beside) ExpectWell(pid);
}
