#include "coordinator/os/socket_server.h"

#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/stat.h>

#include "coordinator/port/unique_fd.h"

namespace tcs {
namespace {

std::uint64_t SocketInode(int fd) {
  struct stat status {};
  fstat(fd, &status);
  return status.st_ino;
}

// A server of that family at the loopback interface, and a client that is connected to it.
struct Pair {
  Pair(int family, int type) : server(socket(family, type, 0)), client(socket(family, type, 0)) {
    socklen_t size = 0;
    if (family == AF_INET) {
      sockaddr_in four{};
      four.sin_family = AF_INET;
      four.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
      size = sizeof four;
      *reinterpret_cast<sockaddr_in*>(&at) = four;
    } else {
      sockaddr_in6 six{};
      six.sin6_family = AF_INET6;
      six.sin6_addr = in6addr_loopback;
      size = sizeof six;
      *reinterpret_cast<sockaddr_in6*>(&at) = six;
    }
    auto* const address = reinterpret_cast<sockaddr*>(&at);
    works = bind(server.get(), address, size) == 0 &&
            (type != SOCK_STREAM || listen(server.get(), 1) == 0) &&
            getsockname(server.get(), address, &size) == 0 &&
            connect(client.get(), address, size) == 0;
  }

  UniqueFd server, client;
  sockaddr_storage at{};
  bool works = false;
};

TEST(SocketServerTest, TheKernelSaysWhoListensAndWhoReceives) {
  for (const int family : {AF_INET, AF_INET6}) {
    for (const int type : {SOCK_STREAM, SOCK_DGRAM}) {
      const Pair pair(family, type);
      if (!pair.works && family == AF_INET6) continue;  // this computer has no IPv6
      ASSERT_TRUE(pair.works);
      const auto server = ServerOf(pair.client.get(), pair.at);
      if (!server.has_value()) GTEST_SKIP() << "the kernel does not say it here";
      EXPECT_EQ(*server, SocketInode(pair.server.get())) << family << " " << type;
    }
  }
}

TEST(SocketServerTest, NobodyIsThereOnceItIsClosed) {
  Pair pair(AF_INET, SOCK_STREAM);
  ASSERT_TRUE(pair.works);
  pair.server.Reset();
  const auto server = ServerOf(pair.client.get(), pair.at);
  if (!server.has_value()) GTEST_SKIP() << "the kernel does not say it here";
  EXPECT_EQ(*server, 0u);
}

}  // namespace
}  // namespace tcs
