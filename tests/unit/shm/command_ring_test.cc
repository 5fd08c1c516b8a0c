#include "shm/command_ring.h"

#include <gtest/gtest.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace tcs::shm {
namespace {

class CommandRingTest : public testing::Test {
 protected:
  // False: it is full.
  bool Post(const std::string& text, std::int64_t time_ns = 0) {
    if (!HasRoomFor(*ring_, text.size())) return false;
    PostInto(*ring_, {time_ns, 0, 0, static_cast<std::uint32_t>(text.size())},
             [&](std::uint64_t at) { CopyIntoRing(*ring_, at, text.data(), text.size()); });
    return true;
  }
  // The next one; none where what is there cannot be.
  std::optional<std::string> Take() {
    if (!ReadHead(*ring_, position_, ring_->posted, &head_)) return std::nullopt;
    std::string text(head_.size, '\0');
    CopyFromRing(*ring_, position_ + sizeof head_, text.data(), text.size());
    position_ += RoomFor(head_.size);
    ring_->taken = position_;
    return text;
  }

  std::unique_ptr<CommandRing> ring_ = std::make_unique<CommandRing>();
  std::uint64_t position_ = 0;
  CommandRing::Head head_{};
};

TEST_F(CommandRingTest, GivesWhatWasPostedInItsOrderWithItsTimes) {
  EXPECT_TRUE(Post("one", 10));
  EXPECT_TRUE(Post("another one", 20));
  EXPECT_EQ(Take(), "one");
  EXPECT_EQ(head_.time_ns, 10);
  EXPECT_EQ(Take(), "another one");
  EXPECT_EQ(head_.time_ns, 20);
  EXPECT_EQ(position_, ring_->posted.load());
}

TEST_F(CommandRingTest, GoesOnAtItsBeginning) {
  for (std::size_t i = 0; i < 5000; ++i) {
    const std::string text(1 + i * 37 % CommandRing::kMostSize, static_cast<char>('a' + i % 26));
    ASSERT_TRUE(Post(text));
    ASSERT_EQ(Take(), text);
  }
}

TEST_F(CommandRingTest, HasRoomAgainOnceSomethingIsTaken) {
  const std::string text(100, 'x');
  int posted = 0;
  while (Post(text)) ++posted;
  EXPECT_EQ(posted, CommandRing::kBytes / RoomFor(100));
  EXPECT_EQ(Take(), text);
  EXPECT_TRUE(Post(text));
  EXPECT_FALSE(Post(text));
}

TEST_F(CommandRingTest, HasNoRoomForNothingNorForMoreThanItself) {
  EXPECT_FALSE(HasRoomFor(*ring_, 0));
  EXPECT_TRUE(HasRoomFor(*ring_, CommandRing::kMostSize));
  EXPECT_FALSE(HasRoomFor(*ring_, CommandRing::kMostSize + 1));
  EXPECT_FALSE(HasRoomFor(*ring_, ~std::uint64_t{0}));
}

// Somebody has written over where it is emptied.
TEST_F(CommandRingTest, HasNoRoomWhereItIsEmptiedBeyondItsEnd) {
  ring_->taken = 8;
  EXPECT_FALSE(HasRoomFor(*ring_, 1));
}

TEST_F(CommandRingTest, FindsWhatCannotBe) {
  EXPECT_TRUE(Post("text"));
  const std::uint64_t end = ring_->posted;
  EXPECT_TRUE(ReadHead(*ring_, 0, end, &head_));
  EXPECT_FALSE(ReadHead(*ring_, 0, end - 1, &head_));
  EXPECT_FALSE(ReadHead(*ring_, end, end, &head_));
  EXPECT_FALSE(ReadHead(*ring_, 8, 0, &head_));
  EXPECT_FALSE(ReadHead(*ring_, 0, CommandRing::kBytes + 8, &head_));
  for (const std::uint32_t size : {0u, 9u, 2009u, ~0u}) {
    CopyIntoRing(*ring_, offsetof(CommandRing::Head, size), &size, sizeof size);
    EXPECT_FALSE(ReadHead(*ring_, 0, end, &head_)) << size;
  }
}

}  // namespace
}  // namespace tcs::shm
