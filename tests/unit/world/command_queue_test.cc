#include "coordinator/world/command_queue.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "coordinator/world/commands.h"
#include "tests/unit/times.h"

namespace tcs {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

class CommandQueueTest : public testing::Test {
 protected:
  CommandQueueTest() { commands_.Open({{.name = "bow", .body = 3}, {.name = "stern", .body = 4}}); }
  void Send(std::size_t channel, std::int64_t ms, double force_n) {
    queue_.Take(channel, AtMs(ms), Wrench{.force_n = {force_n, 0, 0}});
  }
  bool PassOn(std::int64_t ms) {
    return queue_.PassOn(AtMs(ms), [this](VirtualTime at) {
      acted_.push_back("until " + std::to_string(at.ns() / 1'000'000));
    });
  }

  std::vector<std::string> warnings_, acted_;
  Commands commands_{[this](const std::string& text) { warnings_.push_back(text); },
                     [this](VirtualTime sent, VirtualDuration, int body, const Wrench& wrench) {
                       acted_.push_back(std::to_string(sent.ns() / 1'000'000) + " ms: body " +
                                        std::to_string(body) + ", " +
                                        std::to_string(static_cast<int>(wrench.force_n[0])) + " N");
                     }};
  CommandQueue queue_{commands_};
};

TEST_F(CommandQueueTest, GivesOnWhatCanHaveNothingBeforeItAnyMore) {
  Send(0, 3, 7);
  EXPECT_FALSE(PassOn(2));
  EXPECT_THAT(acted_, IsEmpty());
  EXPECT_EQ(commands_.taken(), 0);
  EXPECT_TRUE(PassOn(3));
  EXPECT_THAT(acted_, ElementsAre("until 3", "3 ms: body 3, 7 N"));
  EXPECT_FALSE(PassOn(4)) << "once";
  EXPECT_EQ(commands_.taken(), 1);
}

// In the order of their times, whoever was dispatched first; those of an instant as they came.
TEST_F(CommandQueueTest, IsInTheOrderOfTimes) {
  Send(0, 5, 1);
  Send(1, 3, 2);
  Send(0, 3, 3);
  Send(1, 4, 4);
  EXPECT_TRUE(PassOn(4));
  EXPECT_THAT(acted_, ElementsAre("until 3", "3 ms: body 4, 2 N", "until 3", "3 ms: body 3, 3 N",
                                  "until 4", "4 ms: body 4, 4 N"));
  acted_.clear();
  EXPECT_TRUE(PassOn(9));
  EXPECT_THAT(acted_, ElementsAre("until 5", "5 ms: body 3, 1 N"));
}

TEST_F(CommandQueueTest, KeepsNoComplaint) {
  queue_.Refuse(0, "the command datagram is none");
  EXPECT_THAT(warnings_, ElementsAre("channel bow: the command datagram is none"));
}

}  // namespace
}  // namespace tcs
