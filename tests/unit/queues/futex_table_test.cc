#include "coordinator/queues/futex_table.h"

#include <gtest/gtest.h>

#include <map>

namespace tcs {
namespace {

constexpr std::uint32_t kAnyBit = ~std::uint32_t{0};
constexpr FutexKey kWord{.pid = 7, .address = 0x1000}, kOtherWord{.pid = 7, .address = 0x2000},
    kLock{.pid = 7, .address = 0x3008};

class FutexTableTest : public testing::Test {
 protected:
  using Threads = std::vector<FutexTable::Thread>;

  std::map<FutexTable::Thread, int> priorities_;  // 0 if it is not in it
  FutexTable table_{[this](FutexTable::Thread thread) { return priorities_[thread]; }};
};

TEST_F(FutexTableTest, NobodyWaitsAtFirst) {
  EXPECT_EQ(table_.MostUrgent(kWord, kAnyBit), FutexTable::kNobody);
  EXPECT_TRUE(table_.WaitersAt(kWord).empty());
  EXPECT_FALSE(table_.MayBeWaitedAt(kWord.address));
}

TEST_F(FutexTableTest, AmongEqualsTheOneThatHasWaitedLongestIsFirst) {
  table_.Wait(5, kWord, kAnyBit);
  table_.Wait(3, kWord, kAnyBit);
  EXPECT_EQ(table_.MostUrgent(kWord, kAnyBit), 5);
  table_.Leave(5);
  EXPECT_EQ(table_.MostUrgent(kWord, kAnyBit), 3);
}

TEST_F(FutexTableTest, TheMostUrgentIsFirstByItsPriorityAsItIsNow) {
  table_.Wait(1, kWord, kAnyBit);
  table_.Wait(2, kWord, kAnyBit);
  priorities_[2] = 10;
  EXPECT_EQ(table_.MostUrgent(kWord, kAnyBit), 2);
  priorities_[1] = 20;
  EXPECT_EQ(table_.MostUrgent(kWord, kAnyBit), 1);
}

TEST_F(FutexTableTest, AWakePassesThoseByThatWaitForOtherBits) {
  table_.Wait(1, kWord, 0b01);
  table_.Wait(2, kWord, 0b10);
  EXPECT_EQ(table_.MostUrgent(kWord, 0b10), 2);
  EXPECT_EQ(table_.MostUrgent(kWord, 0b100), FutexTable::kNobody);
}

TEST_F(FutexTableTest, WordsOfOtherProcessesAtTheSameAddressAreOthers) {
  table_.Wait(1, kWord, kAnyBit);
  EXPECT_EQ(table_.MostUrgent({.pid = 8, .address = kWord.address}, kAnyBit), FutexTable::kNobody);
  // But before one knows what an address is mapped to, somebody may wait there.
  EXPECT_TRUE(table_.MayBeWaitedAt(0x77000 | (kWord.address & 0xfff)));
  EXPECT_FALSE(table_.MayBeWaitedAt(kWord.address + 4));
}

TEST_F(FutexTableTest, WhoeverWaitsForAnyOfSeveralIsFoundAtEachAndLeavesAll) {
  table_.WaitForAny(1, {kWord, kOtherWord}, kAnyBit);
  EXPECT_TRUE(table_.WaitsForAny(1));
  EXPECT_EQ(table_.MostUrgent(kWord, kAnyBit), 1);
  EXPECT_EQ(table_.MostUrgent(kOtherWord, kAnyBit), 1);
  EXPECT_EQ(table_.IndexOf(1, kWord), 0u);
  EXPECT_EQ(table_.IndexOf(1, kOtherWord), 1u);
  table_.Leave(1);
  EXPECT_EQ(table_.MostUrgent(kWord, kAnyBit), FutexTable::kNobody);
  EXPECT_EQ(table_.MostUrgent(kOtherWord, kAnyBit), FutexTable::kNobody);
  EXPECT_FALSE(table_.WaitsForAny(1));
}

TEST_F(FutexTableTest, OneWordTwiceIsLeftTwice) {
  table_.WaitForAny(1, {kWord, kWord}, kAnyBit);
  table_.Leave(1);
  EXPECT_TRUE(table_.WaitersAt(kWord).empty());
  EXPECT_FALSE(table_.MayBeWaitedAt(kWord.address));
}

TEST_F(FutexTableTest, WhoeverIsMovedWaitsBehindThoseAtTheOtherWord) {
  table_.Wait(1, kWord, kAnyBit);
  table_.Wait(2, kOtherWord, kAnyBit);
  table_.Move(1, kWord, kOtherWord);
  EXPECT_TRUE(table_.WaitersAt(kWord).empty());
  EXPECT_EQ(table_.WaitersAt(kOtherWord), (Threads{2, 1}));
  EXPECT_EQ(table_.WordOf(1), kOtherWord);
  // Not from where it does not wait.
  table_.Move(1, kWord, kLock);
  EXPECT_EQ(table_.WordOf(1), kOtherWord);
}

TEST_F(FutexTableTest, WhoeverExpectsALockIsWokenOnlyThere) {
  table_.Wait(1, kWord, kAnyBit);
  table_.ExpectLock(1, kLock);
  EXPECT_EQ(table_.ExpectedLock(1), kLock);
  EXPECT_EQ(table_.MostUrgent(kWord, kAnyBit), FutexTable::kNobody);
  EXPECT_EQ(table_.WaitersAt(kWord), Threads{1});
  table_.Move(1, kWord, kLock);
  EXPECT_FALSE(table_.ExpectedLock(1).has_value());
  EXPECT_EQ(table_.MostUrgent(kLock, kAnyBit), 1);
}

TEST_F(FutexTableTest, ByUrgencyEqualsStayInTheOrderOfWaiting) {
  for (const FutexTable::Thread thread : {4, 2, 9, 1}) table_.Wait(thread, kWord, kAnyBit);
  priorities_[9] = 5;
  EXPECT_EQ(table_.ByUrgency(kWord), (Threads{9, 4, 2, 1}));
}

TEST_F(FutexTableTest, WhoeverDoesNotWaitCanLeave) {
  table_.Leave(1);
  table_.Wait(1, kWord, kAnyBit);
  table_.Leave(1);
  table_.Leave(1);
  EXPECT_EQ(table_.MostUrgent(kWord, kAnyBit), FutexTable::kNobody);
}

}  // namespace
}  // namespace tcs
