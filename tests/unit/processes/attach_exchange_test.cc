#include "coordinator/processes/attach_exchange.h"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include "coordinator/port/unique_fd.h"

namespace tcs {
namespace {

class AttachExchangeTest : public testing::Test {
 protected:
  void SetUp() override {
    int ends[2];
    ASSERT_EQ(socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends), 0);
    ours_.Reset(ends[0]);
    theirs_.Reset(ends[1]);
    hello_.magic = shm::kMagic;
    hello_.version = shm::kVersion;
    hello_.pid = hello_.tid = getpid();
  }
  void Say() const { ASSERT_EQ(send(theirs_.get(), &hello_, sizeof hello_, 0), sizeof hello_); }

  UniqueFd ours_, theirs_;
  shm::AttachHello hello_{};
};

TEST_F(AttachExchangeTest, AHelloIsSeenBeforeItIsTaken) {
  EXPECT_FALSE(PeekHello(ours_.get()).has_value());
  Say();
  ASSERT_TRUE(PeekHello(ours_.get()).has_value());
  EXPECT_EQ(PeekHello(ours_.get())->tid, getpid());
  EXPECT_TRUE(TakeHello(ours_.get()).hello.has_value());
  EXPECT_TRUE(TakeHello(ours_.get()).has_gone);
}

TEST_F(AttachExchangeTest, NobodySpeaksForAnotherProcess) {
  hello_.pid = getppid();
  Say();
  EXPECT_FALSE(PeekHello(ours_.get()).has_value());
  const TakenHello taken = TakeHello(ours_.get());
  EXPECT_FALSE(taken.has_gone);
  EXPECT_FALSE(taken.hello.has_value());
}

TEST_F(AttachExchangeTest, AnotherVersionIsNotUnderstood) {
  ++hello_.version;
  Say();
  EXPECT_FALSE(TakeHello(ours_.get()).hello.has_value());
}

TEST_F(AttachExchangeTest, AnAnswerCarriesTheSlotOrWhyThereIsNone) {
  shm::AttachReply reply{};
  Accept(ours_.get(), 7, {});
  ASSERT_EQ(recv(theirs_.get(), &reply, sizeof reply, MSG_DONTWAIT), sizeof reply);
  EXPECT_EQ(reply.refused, 0u);
  EXPECT_EQ(reply.slot, 7u);
  Refuse(ours_.get(), "it has not joined");
  ASSERT_EQ(recv(theirs_.get(), &reply, sizeof reply, MSG_DONTWAIT), sizeof reply);
  EXPECT_EQ(reply.refused, 1u);
  EXPECT_STREQ(reply.text, "it has not joined");
}

}  // namespace
}  // namespace tcs
