// One of several robots that tick. A thousand times a second, from a moment of its own on, it looks
// into a socket for its sensor's readings, computes for a while that differs, commands, tells a
// second program of its robot, and sleeps. Checks as it goes that each look finds all readings from
// before it and none from after it.
//
//   local_ticker NAME TICKS PHASE_US [ODD]
//
// Sensor readings come to @NAME/in, commands go to @NAME/hands. ODD, at each 50th tick:
//   compute  computes for 3 ms
//   raw      sleeps by a system call made raw
//   print    prints the time
//   write    sends its command by write(2) on a connected socket
// Prints "TICKS wrong WRONG" at the end; and when SIGUSR1 came, if it did: "signal AT"; and of a
// datagram of two bytes that came to @NAME/told: "found IN_VAIN AT", when it had last looked in
// vain, and when it found it.
#include <errno.h>
#include <signal.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/un.h>
#include <time.h>
#include <unistd.h>

#include <cstdint>
#include <string>
#include <utility>

namespace {

constexpr std::int64_t kStartNs = 1'000'000'000'000;  // robots start at 1000 s
constexpr std::int64_t kPeriodNs = 1'000'000;
constexpr int kFirstTicks = 20;

std::int64_t NowNs() {
  timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return t.tv_sec * 1'000'000'000 + t.tv_nsec - kStartNs;
}

volatile std::int64_t signalled_ns = 0;

void OnSignal(int) { signalled_ns = NowNs(); }

socklen_t Fill(sockaddr_un* address, const std::string& name) {
  *address = {};
  address->sun_family = AF_UNIX;
  memcpy(address->sun_path + 1, name.data(), name.size());
  return static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + name.size());
}

int Receiver(const std::string& name) {
  const int fd = socket(AF_UNIX, SOCK_DGRAM | SOCK_NONBLOCK, 0);
  sockaddr_un address;
  const socklen_t size = Fill(&address, name);
  if (bind(fd, reinterpret_cast<const sockaddr*>(&address), size) != 0) {
    perror("bind");
    exit(1);
  }
  return fd;
}

void Compute(std::int64_t ns) {
  const std::int64_t end = NowNs() + ns;
  while (NowNs() < end) {
  }
}

// The time of the newest reading, in ms; -1: there is none.
std::int64_t Newest(int fd) {
  std::int64_t newest = -1;
  char text[512];
  for (ssize_t size; (size = recv(fd, text, sizeof text - 1, 0)) > 0;) {
    text[size] = '\0';
    const char* time = strstr(text, "\"time\":");
    if (time == nullptr) exit(3);
    newest = static_cast<std::int64_t>(atof(time + 7) * 1000 + 0.5);
  }
  return newest;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 4) return 2;
  const std::string name = argv[1], odd = argc > 4 ? argv[4] : "";
  const int ticks = atoi(argv[2]);
  const int in = Receiver(name + "/in"), told = Receiver(name + "/told");
  sockaddr_un hands, second;
  const socklen_t hands_size = Fill(&hands, name + "/hands");
  const socklen_t second_size = Fill(&second, name + "/told");
  const int out = socket(AF_UNIX, SOCK_DGRAM, 0);
  connect(out, reinterpret_cast<const sockaddr*>(&hands), hands_size);
  std::int64_t due = 100'000'000 + atoll(argv[3]) * 1000, known = -1;
  std::uint32_t random = static_cast<std::uint32_t>(atoi(argv[3])) + 1;
  int wrong = 0;
  std::int64_t in_vain = 0, looked = 0, found = 0;
  signal(SIGUSR1, OnSignal);
  for (int tick = 0; tick < ticks; ++tick, due += kPeriodNs) {
    const std::int64_t at = due + kStartNs;
    const timespec t{at / 1'000'000'000, at % 1'000'000'000};
    const bool is_odd = tick % 50 == 49;
    if (is_odd && odd == "raw") {
      syscall(SYS_clock_nanosleep, CLOCK_MONOTONIC, TIMER_ABSTIME, &t, nullptr);
    } else {
      while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &t, nullptr) == EINTR) {
      }
    }
    const std::int64_t before = NowNs();
    const std::int64_t newest = Newest(in);
    const std::int64_t after = NowNs();
    if (newest >= 0) known = newest;
    // One each ms, at whole ones. What came before the first ticks has to be caught up with.
    const bool is_right =
        tick < kFirstTicks || (known * kPeriodNs <= after && (known + 1) * kPeriodNs > before);
    if ((!is_right || before < due) && ++wrong <= 5) {
      fprintf(stderr, "tick %d due %lld: looked from %lld to %lld, and know of %lld ms\n", tick,
              (long long)due, (long long)before, (long long)after, (long long)known);
    }
    random = random * 1664525 + 1013904223;
    Compute(random >> 24 << 7);  // up to 32 us
    if (is_odd && odd == "compute") Compute(3'000'000);
    char command[96];
    snprintf(command, sizeof command, "{\"force\":[%d,0,0]}", tick);
    if (is_odd && odd == "write") {
      if (write(out, command, strlen(command)) < 0) perror("write");
    } else if (sendto(in, command, strlen(command), 0, reinterpret_cast<const sockaddr*>(&hands),
                      hands_size) < 0) {
      perror("sendto");
    }
    // To itself: the kernel carries it, at once.
    char back[8];
    sendto(in, "x", 1, 0, reinterpret_cast<const sockaddr*>(&second), second_size);
    const std::int64_t last = std::exchange(looked, NowNs());
    ssize_t size = recv(told, back, sizeof back, 0);
    if (size == 2) {
      in_vain = last;
      found = NowNs();
      size = recv(told, back, sizeof back, 0);
    }
    if (size != 1 && ++wrong <= 5) fprintf(stderr, "tick %d: lost\n", tick);
    if (is_odd && odd == "print") {
      printf("at %lld\n", (long long)NowNs());
      fflush(stdout);
    }
  }
  if (signalled_ns != 0) printf("signal %lld\n", (long long)signalled_ns);
  if (found != 0) printf("found %lld %lld\n", (long long)in_vain, (long long)found);
  printf("%d wrong %d\n", ticks, wrong);
  return wrong == 0 ? 0 : 1;
}
