#include "coordinator/os/own_network.h"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

namespace tcs {
namespace {

// A socket on 127.0.0.1 with this port; 0: any.
int BindTo(std::uint16_t port) {
  const int fd = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  if (bind(fd, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0) return fd;
  close(fd);
  return -1;
}

std::uint16_t PortOf(int fd) {
  sockaddr_in address{};
  socklen_t size = sizeof address;
  getsockname(fd, reinterpret_cast<sockaddr*>(&address), &size);
  return ntohs(address.sin_port);
}

// Whether the byte that was sent comes: the kernel may hand it over later.
bool Comes(int fd) {
  pollfd readable{fd, POLLIN, 0};
  char got = 0;
  return poll(&readable, 1, 60'000) == 1 && recv(fd, &got, 1, MSG_DONTWAIT) == 1 && got == 'x';
}

// The exit status of `inside`, run in a network of its own.
template <typename Inside>
int InOwnNetwork(Inside inside) {
  const pid_t pid = fork();
  if (pid == 0) _exit(EnterOwnNetwork().empty() ? inside() : 99);
  int status = -1;
  waitpid(pid, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

class OwnNetwork : public ::testing::Test {
 protected:
  void SetUp() override {
    if (const std::string why = WhyNoOwnNetwork(); !why.empty()) GTEST_SKIP() << why;
  }
};

TEST_F(OwnNetwork, APortThatIsTakenHereIsFreeThere) {
  const int fd = BindTo(0);
  ASSERT_GE(fd, 0);
  ASSERT_LT(BindTo(PortOf(fd)), 0) << "it is taken here";
  EXPECT_EQ(InOwnNetwork([fd] { return BindTo(PortOf(fd)) >= 0 ? 7 : 8; }), 7);
  close(fd);
}

TEST_F(OwnNetwork, DatagramsArriveByLoopback) {
  EXPECT_EQ(InOwnNetwork([] {
              const int to = BindTo(27499), from = BindTo(0);
              sockaddr_in address{};
              address.sin_family = AF_INET;
              address.sin_port = htons(27499);
              address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
              const bool sent = sendto(from, "x", 1, 0, reinterpret_cast<sockaddr*>(&address),
                                       sizeof address) == 1;
              return sent && Comes(to) ? 7 : 8;
            }),
            7);
}

TEST_F(OwnNetwork, MulticastFindsWhoeverJoinsWithoutNamingAnInterface) {
  EXPECT_EQ(InOwnNetwork([] {
              const int to = socket(AF_INET, SOCK_DGRAM, 0), from = socket(AF_INET, SOCK_DGRAM, 0);
              sockaddr_in address{};
              address.sin_family = AF_INET;
              address.sin_port = htons(27499);
              bind(to, reinterpret_cast<sockaddr*>(&address), sizeof address);
              inet_pton(AF_INET, "239.255.0.1", &address.sin_addr);
              const ip_mreq group{address.sin_addr, {}};
              if (setsockopt(to, IPPROTO_IP, IP_ADD_MEMBERSHIP, &group, sizeof group) != 0)
                return 8;
              const bool sent = sendto(from, "x", 1, 0, reinterpret_cast<sockaddr*>(&address),
                                       sizeof address) == 1;
              return sent && Comes(to) ? 7 : 9;
            }),
            7);
}

TEST_F(OwnNetwork, EverybodyStaysWhoTheyAre) {
  const uid_t user = getuid();
  EXPECT_EQ(InOwnNetwork([user] { return getuid() == user ? 7 : 8; }), 7);
}

}  // namespace
}  // namespace tcs
