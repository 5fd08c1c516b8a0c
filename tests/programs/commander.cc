// commander unix|udp ADDRESS WAY COUNT TICKS: sends COUNT commands at each of so many multiples of
//   10 ms, in that way, and prints how often it was stopped, and its parent woke, while it did.
// commander unix|udp ADDRESS errors [own]: sends what cannot be sent, and prints what comes of it.
//   own: at the address there is a socket of its own.
#include <arpa/inet.h>
#include <errno.h>
#include <netinet/in.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <string>
#include <thread>
#include <vector>

namespace {

constexpr std::int64_t kSecond = 1'000'000'000, kPeriod = 10'000'000;
constexpr std::size_t kLong = 3000;  // bytes of a command that is too long to be posted

struct Address {
  sockaddr_storage of{};
  socklen_t size = 0;
  const sockaddr* get() const { return reinterpret_cast<const sockaddr*>(&of); }
};

int g_family = AF_UNIX;
Address g_to;

// "@NAME", or "HOST:PORT".
Address AddressOf(const std::string& text) {
  Address address;
  if (g_family == AF_UNIX) {
    auto& name = reinterpret_cast<sockaddr_un&>(address.of);
    name.sun_family = AF_UNIX;
    memcpy(name.sun_path + 1, text.data() + 1, text.size() - 1);
    address.size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + text.size());
    return address;
  }
  auto& port = reinterpret_cast<sockaddr_in&>(address.of);
  port.sin_family = AF_INET;
  const std::size_t colon = text.find(':');
  port.sin_port = htons(static_cast<std::uint16_t>(atoi(text.c_str() + colon + 1)));
  inet_pton(AF_INET, text.substr(0, colon).c_str(), &port.sin_addr);
  address.size = sizeof port;
  return address;
}

int Socket(bool connected) {
  const int fd = socket(g_family, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (connected && connect(fd, g_to.get(), g_to.size) != 0) abort();
  return fd;
}

std::string Command(int number) { return R"({"force": [)" + std::to_string(number) + ", 0, 0]}"; }

void Sent(ssize_t sent, std::size_t size) {
  if (sent == static_cast<ssize_t>(size)) return;
  perror("commander");
  _exit(1);
}

msghdr MessageOf(std::vector<iovec>& parts, bool addressed) {
  msghdr message{};
  if (addressed) message.msg_name = &g_to.of;
  if (addressed) message.msg_namelen = g_to.size;
  message.msg_iov = parts.data();
  message.msg_iovlen = parts.size();
  return message;
}

using Commands = std::vector<std::string>;
using Way = std::function<void(Commands)>;

void ByOneCall(int fd, const Commands& commands) {
  std::vector<std::vector<iovec>> parts(commands.size());
  std::vector<mmsghdr> messages(commands.size());
  for (std::size_t i = 0; i < commands.size(); ++i) {
    parts[i] = {{const_cast<char*>(commands[i].data()), commands[i].size()}};
    messages[i] = {MessageOf(parts[i], true), 0};
  }
  Sent(sendmmsg(fd, messages.data(), static_cast<unsigned>(messages.size()), 0), messages.size());
  for (std::size_t i = 0; i < commands.size(); ++i) Sent(messages[i].msg_len, commands[i].size());
}

Way WayCalled(const std::string& way) {
  const bool connected = way == "write" || way == "send" || way == "child" || way == "thread";
  const int fd = Socket(connected);
  const auto each = [](const std::function<ssize_t(const std::string&)>& send) {
    return [send](const Commands& commands) {
      for (const std::string& command : commands) Sent(send(command), command.size());
    };
  };
  const auto send_all =
      each([fd](const std::string& c) { return send(fd, c.data(), c.size(), 0); });
  const auto to = each([fd](const std::string& c) {
    return sendto(fd, c.data(), c.size(), MSG_DONTWAIT | MSG_NOSIGNAL, g_to.get(), g_to.size);
  });
  if (way == "write") {
    return each([fd](const std::string& c) { return write(fd, c.data(), c.size()); });
  }
  if (way == "send") return send_all;
  if (way == "sendto") return to;
  if (way == "sendmsg") {
    return each([fd](const std::string& c) {
      std::vector<iovec> parts = {{const_cast<char*>(c.data()), 5},
                                  {nullptr, 0},
                                  {const_cast<char*>(c.data()) + 5, c.size() - 5}};
      const msghdr message = MessageOf(parts, true);
      return sendmsg(fd, &message, 0);
    });
  }
  if (way == "sendmmsg") return [fd](const Commands& c) { ByOneCall(fd, c); };
  // The kernel carries each second one.
  const auto each_second_long = [](Commands commands) {
    for (std::size_t i = 1; i < commands.size(); i += 2) commands[i].resize(kLong, ' ');
    return commands;
  };
  if (way == "long") return [=](const Commands& c) { to(each_second_long(c)); };
  if (way == "long_sendmmsg") return [=](const Commands& c) { ByOneCall(fd, each_second_long(c)); };
  if (way == "beside") {
    const int written = Socket(true);
    const auto beside =
        each([=](const std::string& c) { return write(written, c.data(), c.size()); });
    return [=](const Commands& c) {
      for (std::size_t i = 0; i < c.size(); ++i) (i % 2 == 0 ? to : beside)({c[i]});
    };
  }
  if (way == "child") {
    return [=](const Commands& c) {
      const pid_t child = fork();
      if (child == 0) {
        send_all(c);
        _exit(0);
      }
      waitpid(child, nullptr, 0);
    };
  }
  if (way == "thread") {
    return [=](const Commands& c) { std::thread([&] { send_all(c); }).join(); };
  }
  fprintf(stderr, "no way called %s\n", way.c_str());
  exit(2);
}

long FieldOf(const std::string& status, const char* field) {
  FILE* file = fopen(status.c_str(), "re");
  char line[256];
  long value = -1;
  while (file != nullptr && fgets(line, sizeof line, file) != nullptr) {
    if (strncmp(line, field, strlen(field)) == 0) value = atol(line + strlen(field) + 1);
  }
  if (file != nullptr) fclose(file);
  return value;
}

// How often this thread was stopped, and how often the parent has slept.
long Stops() { return FieldOf("/proc/thread-self/status", "nonvoluntary_ctxt_switches"); }
long Sleeps() {
  return FieldOf("/proc/" + std::to_string(getppid()) + "/status", "voluntary_ctxt_switches");
}

int SendOnTime(const Way& send, int count, int ticks) {
  timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  std::int64_t at = (now.tv_sec * kSecond + now.tv_nsec) / kPeriod * kPeriod;
  long stops = 0, sleeps = 0;
  for (int tick = 0; tick < ticks; ++tick) {
    at += kPeriod;
    const timespec until{at / kSecond, at % kSecond};
    clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr);
    if (tick == ticks / 10) stops = Stops(), sleeps = Sleeps();
    Commands commands;
    for (int i = 0; i < count; ++i) commands.push_back(Command(tick * count + i));
    send(commands);
  }
  printf("stops %ld sleeps %ld\n", Stops() - stops, Sleeps() - sleeps);
  usleep(50'000);  // the last ones act, too
  return 0;
}

void Say(const char* what, ssize_t result) {
  const int error = errno;
  printf("%s: %zd %s\n", what, result, result < 0 ? strerrorname_np(error) : "");
}

int SendWhatCannotBeSent() {
  const std::string command = Command(1);
  const auto to = [&](int fd, std::size_t size, int flags = 0) {
    static const std::string text(1 << 20, ' ');
    return sendto(fd, text.data(), size, flags, g_to.get(), g_to.size);
  };
  const auto send_to = [&](int fd, const void* bytes, std::size_t size, socklen_t address_size) {
    return sendto(fd, bytes, size, 0, g_to.get(), address_size);
  };
  char* none = static_cast<char*>(
      mmap(nullptr, 8192, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0));
  mprotect(none + 4096, 4096, PROT_NONE);
  int fd = Socket(false);
  Say("without an address", send(fd, command.data(), command.size(), 0));
  Say("to an address that is cut off", send_to(fd, command.data(), command.size(), 1));
  Say("what cannot be read", send_to(fd, none + 4096, 100, g_to.size));
  Say("what can be read by half", send_to(fd, none + 4000, 200, g_to.size));
  Say("out of band", to(fd, 100, MSG_OOB));
  Say("a megabyte", to(fd, 1 << 20));
  Say("70000 bytes in two parts", [&] {
    static std::string half(35000, ' ');
    std::vector<iovec> parts = {{half.data(), half.size()}, {half.data(), half.size()}};
    const msghdr message = MessageOf(parts, true);
    return g_family == AF_INET ? sendmsg(fd, &message, 0) : -2;
  }());
  Say("well", to(fd, 100));
  sockaddr_storage own{};
  socklen_t size = sizeof own;
  getsockname(fd, reinterpret_cast<sockaddr*>(&own), &size);
  Say("has a port", g_family == AF_INET && reinterpret_cast<sockaddr_in&>(own).sin_port != 0);
  shutdown(fd, SHUT_WR);
  Say("shut down", to(fd, 100));
  Say("shut down, no signal", to(fd, 100, MSG_NOSIGNAL));
  close(fd);
  Say("closed", to(fd, 100));
  Say("a pipe's end", [&] {
    int ends[2];
    if (pipe(ends) != 0) abort();
    return to(ends[1], 100);
  }());
  fd = socket(g_family, SOCK_STREAM, 0);
  Say("a stream", to(fd, 100, MSG_NOSIGNAL));
  int pair[2];
  if (socketpair(AF_UNIX, SOCK_SEQPACKET, 0, pair) != 0) abort();
  Say("a pair", to(pair[0], 100));
  Say("comes out", recv(pair[1], none, 200, MSG_DONTWAIT));
  Say("of the other family", to(socket(g_family == AF_UNIX ? AF_INET : AF_UNIX, SOCK_DGRAM, 0), 9));
  if (g_family == AF_INET) {
    fd = Socket(true);
    Say("a part", to(fd, 100, MSG_MORE));
    Say("the rest", to(fd, 100));
    // Somebody is not there.
    Address nobody = g_to;
    reinterpret_cast<sockaddr_in&>(nobody.of).sin_port = htons(9);
    if (connect(fd, nobody.get(), nobody.size) != 0) abort();
    Say("to nobody", send(fd, command.data(), command.size(), 0));
    usleep(20'000);
    Say("after that", to(fd, 100));
    Say("and again", to(fd, 100));
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 4) return 2;
  if (strcmp(argv[1], "udp") == 0) g_family = AF_INET;
  g_to = AddressOf(argv[2]);
  if (strcmp(argv[3], "errors") == 0) {
    const bool has_own = argc > 4 && strcmp(argv[4], "own") == 0;
    if (has_own && bind(Socket(false), g_to.get(), g_to.size) != 0) return 1;
    return SendWhatCannotBeSent();
  }
  return argc < 6 ? 2 : SendOnTime(WayCalled(argv[3]), atoi(argv[4]), atoi(argv[5]));
}
