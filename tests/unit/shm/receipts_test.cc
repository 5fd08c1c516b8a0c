#include "shm/receipts.h"

#include <gtest/gtest.h>

namespace tcs::shm {
namespace {

constexpr std::int64_t kWork = Receipts::kWorkNs;

TEST(Receipts, AllocationsAreCountedFromTheEndOfAWaitOn) {
  Receipts receipts{};
  NoteStarted(receipts);
  receipts.allocations = 7;
  NoteReceived(receipts, 5 * kWork);
  NoteSent(receipts);
  EXPECT_EQ(receipts.allocations, 7u);
  NoteWoken(receipts);
  EXPECT_EQ(receipts.allocations, 0u);
}

TEST(Receipts, WhatAWaitHasEndedForIsTheActivationsOwn) {
  Receipts receipts{};
  NoteWoken(receipts);
  EXPECT_FALSE(NoteReceived(receipts, 5 * kWork));
}

TEST(Receipts, SeveralPiecesInOneGoAreOneActivation) {
  Receipts receipts{};
  NoteWoken(receipts);
  EXPECT_FALSE(NoteReceived(receipts, 0));
  EXPECT_FALSE(NoteReceived(receipts, kWork - 1));
  EXPECT_FALSE(NoteReceived(receipts, 2 * kWork - 2));
}

TEST(Receipts, WhoeverReceivesAfterComputingIsAtItsNextActivation) {
  Receipts receipts{};
  NoteWoken(receipts);
  EXPECT_FALSE(NoteReceived(receipts, 0));
  EXPECT_TRUE(NoteReceived(receipts, kWork));
  EXPECT_FALSE(NoteReceived(receipts, kWork + 1));
  EXPECT_TRUE(NoteReceived(receipts, 3 * kWork));
}

TEST(Receipts, AndSoIsWhoeverHasSentSomething) {
  Receipts receipts{};
  NoteWoken(receipts);
  EXPECT_FALSE(NoteReceived(receipts, 0));
  NoteSent(receipts);
  EXPECT_TRUE(NoteReceived(receipts, 1));
  EXPECT_FALSE(NoteReceived(receipts, 2));
}

TEST(Receipts, SendingBeforeTheFirstOneBeginsNone) {
  Receipts receipts{};
  NoteWoken(receipts);
  NoteSent(receipts);
  EXPECT_FALSE(NoteReceived(receipts, 10 * kWork));
}

TEST(Receipts, AWaitBeginsAnew) {
  Receipts receipts{};
  NoteWoken(receipts);
  EXPECT_FALSE(NoteReceived(receipts, 0));
  NoteSent(receipts);
  NoteWoken(receipts);
  EXPECT_FALSE(NoteReceived(receipts, 10 * kWork));
}

TEST(Receipts, TheFirstMessageEndsTheStart) {
  Receipts receipts{};
  NoteStarted(receipts);
  EXPECT_TRUE(NoteReceived(receipts, 1));
  EXPECT_FALSE(NoteReceived(receipts, 2));
}

}  // namespace
}  // namespace tcs::shm
