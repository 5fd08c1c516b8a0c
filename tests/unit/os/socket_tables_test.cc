#include "coordinator/os/socket_tables.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <stddef.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <iterator>

#include "coordinator/port/unique_fd.h"

namespace tcs {
namespace {

std::string Contents(const std::string& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::uint64_t InodeOf(int fd) {
  struct stat status {};
  fstat(fd, &status);
  return status.st_ino;
}

TEST(SocketTablesTest, LinesOfBothFamiliesAreRead) {
  const auto four = InternetSocketsOf(
      "  sl  local_address ...\n"
      "   0: 0100007F:2CF7 00000000:0000 0A 00000000:00000000 00:00000000 00000000     0        0 "
      "4711 1 x 100 0 0 10 0\n"
      "nothing\n"
      "   1: 0100007F:2CF8 0200A8C0:0050 01 00000000:00000000 00:00000000 00000000     0        0 "
      "4712 1 x 100 0 0 10 0\n");
  ASSERT_EQ(four.size(), 2u);
  EXPECT_EQ(four[0].local.Text(), "127.0.0.1:11511");
  EXPECT_TRUE(four[0].listens && four[0].local.IsLoopback() && four[0].remote.IsAny());
  EXPECT_EQ(four[1].remote, (InternetAddress{"192.168.0.2", 80}));
  EXPECT_EQ(four[1].inode, 4712u);
  const auto six = InternetSocketsOf(
      "  sl  ...\n"
      "   0: 00000000000000000000000001000000:0050 0000000000000000FFFF00000100007F:0051 01 "
      "00000000:00000000 00:00000000 00000000     0        0 4713 1 x 20 4 30 10 -1\n");
  ASSERT_EQ(six.size(), 1u);
  EXPECT_EQ(six[0].local.Text(), "[::1]:80");
  EXPECT_EQ(six[0].remote.Text(), "127.0.0.1:81");  // as the same program is reached by IPv4
}

// The kernel's own tables.
TEST(SocketTablesTest, OnesOwnListenersAreThere) {
  const UniqueFd listener(socket(AF_INET, SOCK_STREAM, 0));
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  ASSERT_EQ(bind(listener.get(), reinterpret_cast<sockaddr*>(&address), size), 0);
  ASSERT_EQ(listen(listener.get(), 1), 0);
  getsockname(listener.get(), reinterpret_cast<sockaddr*>(&address), &size);
  const auto sockets = InternetSocketsOf(Contents("/proc/self/net/tcp"));
  const auto found = std::find_if(sockets.begin(), sockets.end(), [&](const InternetSocket& each) {
    return each.inode == InodeOf(listener.get());
  });
  ASSERT_NE(found, sockets.end());
  EXPECT_TRUE(found->listens);
  EXPECT_EQ(found->local.port, ntohs(address.sin_port));
  EXPECT_THAT(OwnAddresses(), testing::Contains("127.0.0.1"));
}

TEST(SocketTablesTest, UnixSocketsHaveNames) {
  const UniqueFd listener(socket(AF_UNIX, SOCK_STREAM, 0));
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const std::string name = "tcs socket tables " + std::to_string(getpid());
  std::copy(name.begin(), name.end(), address.sun_path + 1);
  const auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + name.size());
  ASSERT_EQ(bind(listener.get(), reinterpret_cast<sockaddr*>(&address), size), 0);
  ASSERT_EQ(listen(listener.get(), 1), 0);
  const auto sockets = UnixSocketsOf(Contents("/proc/self/net/unix"));
  const auto found = std::find_if(sockets.begin(), sockets.end(), [&](const UnixSocket& each) {
    return each.inode == InodeOf(listener.get());
  });
  ASSERT_NE(found, sockets.end());
  EXPECT_EQ(found->name, "@" + name);
  EXPECT_TRUE(found->listens);
}

}  // namespace
}  // namespace tcs
