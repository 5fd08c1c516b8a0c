#include "coordinator/processes/registration_sockets.h"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>

#include <cstddef>
#include <cstring>
#include <vector>

namespace tcs {
namespace {

class RegistrationSocketsTest : public testing::Test {
 protected:
  void SetUp() override {
    reactor_.On(Tag::kListener, [this](const Subject& subject, std::uint32_t, Moment) {
      EXPECT_TRUE(sockets_.Accept(subject.index));
      return Reactor::Found{};
    });
    reactor_.On(Tag::kConnection, [this](const Subject& subject, std::uint32_t, Moment) {
      auto connection = sockets_.Take(static_cast<int>(subject.index));
      EXPECT_TRUE(connection.has_value());
      if (connection.has_value()) heard_.push_back(connection->client);
      return Reactor::Found{};
    });
  }
  static UniqueFd ConnectTo(const std::string& name) {
    UniqueFd fd(socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0));
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    memcpy(address.sun_path + 1, name.data(), name.size());
    const auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + name.size());
    EXPECT_EQ(connect(fd.get(), reinterpret_cast<sockaddr*>(&address), size), 0);
    return fd;
  }
  void HandleAll() {
    while (reactor_.Wait(HostNs(0)) > 0) reactor_.Handle({});
  }
  static void SayAnythingAt(const UniqueFd& fd) {
    EXPECT_EQ(send(fd.get(), "x", 1, MSG_NOSIGNAL), 1);
  }

  Reactor reactor_;
  RegistrationSockets sockets_{reactor_};
  std::vector<Process*> heard_;
};

TEST_F(RegistrationSocketsTest, WhoComesToAClientsSocketDescendsFromThatClient) {
  Process one, two;
  const std::string first = sockets_.Open(nullptr);
  sockets_.AssignTo(one);
  const std::string second = sockets_.Open(nullptr);
  sockets_.AssignTo(two);
  ASSERT_NE(first, second);
  const UniqueFd at_second = ConnectTo(second), at_first = ConnectTo(first);
  HandleAll();
  EXPECT_TRUE(heard_.empty());  // nobody has said anything
  SayAnythingAt(at_second);
  HandleAll();
  SayAnythingAt(at_first);
  HandleAll();
  EXPECT_EQ(heard_, (std::vector<Process*>{&two, &one}));
}

TEST_F(RegistrationSocketsTest, OfTooManyWhoSayNothingTheEarliestAreCutOff) {
  Process client;
  const std::string name = sockets_.Open(nullptr);
  sockets_.AssignTo(client);
  std::vector<UniqueFd> connected;
  for (std::size_t i = 0; i <= RegistrationSockets::kMostSilent; ++i) {
    connected.push_back(ConnectTo(name));
    HandleAll();
  }
  char byte = 0;
  EXPECT_EQ(recv(connected.front().get(), &byte, 1, MSG_DONTWAIT), 0);  // the other end is closed
  EXPECT_EQ(recv(connected[1].get(), &byte, 1, MSG_DONTWAIT), -1);
  SayAnythingAt(connected.back());
  HandleAll();
  EXPECT_EQ(heard_.size(), 1u);
}

}  // namespace
}  // namespace tcs
