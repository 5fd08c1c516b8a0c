// paced_datagrams send PORT PERIOD_US COUNT: sends its clock to the port once each period, first
//   one period after the next full tenth of a second.
// paced_datagrams receive PORT COUNT: prints, for each datagram, the sender's clock, and its own
//   after it has come back from the wait for it, in ns.
// paced_datagrams compute [look]: computes for ever; with `look` it looks at the clock all the
// time.
#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace {

constexpr std::int64_t kSecond = 1'000'000'000, kTenth = kSecond / 10;

std::int64_t Now() {
  timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return t.tv_sec * kSecond + t.tv_nsec;
}

sockaddr_in Loopback(const char* port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(atoi(port)));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  return address;
}

int Send(const char* port, std::int64_t period_ns, int count) {
  const int fd = socket(AF_INET, SOCK_DGRAM, 0);
  const sockaddr_in to = Loopback(port);
  std::int64_t next = (Now() / kTenth + 1) * kTenth;
  for (int i = 0; i < count; ++i) {
    next += period_ns;
    const timespec until{next / kSecond, next % kSecond};
    clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr);
    const std::int64_t now = Now();
    if (sendto(fd, &now, sizeof now, 0, reinterpret_cast<const sockaddr*>(&to), sizeof to) < 0) {
      return 1;
    }
  }
  return 0;
}

int Receive(const char* port, int count) {
  const int fd = socket(AF_INET, SOCK_DGRAM, 0);
  const sockaddr_in own = Loopback(port);
  if (bind(fd, reinterpret_cast<const sockaddr*>(&own), sizeof own) != 0) return 1;
  for (int i = 0; i < count; ++i) {
    std::int64_t sent = 0;
    if (recv(fd, &sent, sizeof sent, 0) != sizeof sent) return 1;
    const std::int64_t now = Now();
    printf("%lld %lld\n", static_cast<long long>(sent), static_cast<long long>(now));
  }
  return fflush(stdout);
}

[[noreturn]] void Compute(bool looks) {
  volatile long work = 0;
  for (;;) {
    for (int i = 0; i < 1000; ++i) work = work + 1;
    if (looks) Now();
    free(malloc(64));
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc == 5 && strcmp(argv[1], "send") == 0) {
    return Send(argv[2], atoll(argv[3]) * 1000, atoi(argv[4]));
  }
  if (argc == 4 && strcmp(argv[1], "receive") == 0) return Receive(argv[2], atoi(argv[3]));
  if (argc >= 2 && strcmp(argv[1], "compute") == 0) Compute(argc > 2);
  return 2;
}
