#include "coordinator/processes/registration_sockets.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
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
    reactor_.On(Tag::kListener, [this](const Subject& subject, std::uint32_t, EventTime) {
      EXPECT_EQ(sockets_.Accept(subject.index), has_room_);
      return PollOutcome{};
    });
    reactor_.On(Tag::kConnection, [this](const Subject& subject, std::uint32_t, EventTime) {
      auto connection = sockets_.Take(static_cast<int>(subject.index));
      EXPECT_TRUE(connection.has_value());
      if (connection.has_value()) heard_.push_back(connection->client);
      return PollOutcome{};
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
  bool has_room_ = true;  // for somebody else
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

TEST_F(RegistrationSocketsTest, WhoeverComesOnceFilesAreShortIsToldSo) {
  Process client;
  const std::string name = sockets_.Open(nullptr);
  sockets_.AssignTo(client);
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_NOFILE, &before), 0);
  const UniqueFd waits = ConnectTo(name);
  // Room for one more, which is among the last.
  const rlimit few{static_cast<rlim_t>(waits.get()) + 3, before.rlim_max};
  ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &few), 0);
  has_room_ = false;
  ASSERT_GT(reactor_.Wait(HostNs(0)), 0u);
  reactor_.Handle({});
  ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &before), 0);
  sockets_.Close();
  char byte = 0;
  EXPECT_LE(recv(waits.get(), &byte, 1, 0), 0);
  EXPECT_EQ(reactor_.Wait(HostNs(0)), 0u);
}

}  // namespace
}  // namespace tcs
