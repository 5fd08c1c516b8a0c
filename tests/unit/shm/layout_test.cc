// The literals here are the contract between processes that may come from different builds. Whoever
// has to change one bumps kVersion.
#include "shm/layout.h"

#include <gtest/gtest.h>

#include <type_traits>

namespace tcs::shm {
namespace {

TEST(Layout, VersionElevenHasTheseSizesAndPlaces) {
  EXPECT_EQ(kVersion, 11u);
  EXPECT_EQ(sizeof(SegmentHeader), 128u);
  EXPECT_EQ(sizeof(ThreadSlot), 1024u);
  EXPECT_EQ(alignof(ThreadSlot), 64u);
  EXPECT_EQ(offsetof(SegmentHeader, accounting), 24u);
  EXPECT_EQ(offsetof(SegmentHeader, shutdown), 28u);
  EXPECT_EQ(offsetof(SegmentHeader, sync), 52u);
  EXPECT_EQ(offsetof(ClockPage, horizon_ns), 32u);
  EXPECT_EQ(offsetof(ClockPage, waited_adjust), 72u);
  EXPECT_EQ(offsetof(ClockPage, staleness_ns), 152u);
  EXPECT_EQ(offsetof(ClockPage, allocation_cost_ns), 160u);
  EXPECT_EQ(offsetof(ThreadSlot, note), 192u);
  EXPECT_EQ(offsetof(ThreadSlot, gate), 504u);
  EXPECT_EQ(offsetof(ThreadSlot, reply), 512u);
  EXPECT_EQ(offsetof(ThreadSlot, signals), 560u);
  EXPECT_EQ(offsetof(ThreadSlot, receipts), 568u);
}

TEST(Layout, SlotsFollowTheHeaderWithoutAGap) {
  alignas(64) static char segment[sizeof(SegmentHeader) + 2 * sizeof(ThreadSlot)];
  auto* header = reinterpret_cast<SegmentHeader*>(segment);
  EXPECT_EQ(reinterpret_cast<char*>(SlotAt(header, 0)), segment + 128);
  EXPECT_EQ(reinterpret_cast<char*>(SlotAt(header, 1)), segment + 128 + 1024);
  EXPECT_EQ(kIpcTimesAt, 128u + 4096u * 1024u);
  EXPECT_EQ(kSegmentSize, 128u + 4096u * 1024u + 4096u * 32u);
}

TEST(Layout, NothingInItNeedsAConstructorToHaveRun) {
  EXPECT_TRUE(std::is_standard_layout_v<ThreadSlot>);
  EXPECT_TRUE(std::is_trivially_destructible_v<ThreadSlot>);
  EXPECT_NE(kMagic, 0u);
}

}  // namespace
}  // namespace tcs::shm
