// The literals here are the contract between processes that may come from different builds. Whoever
// has to change one bumps kVersion.
#include "shm/layout.h"

#include <gtest/gtest.h>

#include <type_traits>

#include "shm/own_receivers.h"

namespace tcs::shm {
namespace {

TEST(Layout, ThisVersionHasTheseSizesAndPlaces) {
  EXPECT_EQ(kVersion, 32u);
  EXPECT_EQ(sizeof(RunHeader), 128u);
  EXPECT_EQ(sizeof(ThreadSlot), 5696u);
  EXPECT_EQ(alignof(ThreadSlot), 64u);
  EXPECT_EQ(offsetof(RunHeader, accounting), 24u);
  EXPECT_EQ(offsetof(RunHeader, shutdown), 28u);
  EXPECT_EQ(offsetof(RunHeader, sync), 52u);
  EXPECT_EQ(offsetof(RunHeader, has_brokers), 76u);
  EXPECT_EQ(offsetof(RunHeader, names_by_robot), 80u);
  EXPECT_EQ(offsetof(RunHeader, notes_activity), 84u);
  EXPECT_EQ(offsetof(RunHeader, turns_beside), 88u);
  EXPECT_EQ(offsetof(RunHeader, counter_ticks_per_ns_q32), 96u);
  EXPECT_EQ(offsetof(RunHeader, plain_call_ticks), 104u);
  EXPECT_EQ(offsetof(ClockPage, horizon_ns), 32u);
  EXPECT_EQ(offsetof(ClockPage, waited_adjust), 72u);
  EXPECT_EQ(offsetof(ClockPage, staleness_ns), 152u);
  EXPECT_EQ(offsetof(ClockPage, allocation_cost_ns), 160u);
  EXPECT_EQ(offsetof(ClockPage, counts_work), 168u);
  EXPECT_EQ(offsetof(ClockPage, shares_storage), 172u);
  EXPECT_EQ(offsetof(ClockPage, local_read_safe_ns), 176u);
  EXPECT_EQ(offsetof(ThreadSlot, note), 192u);
  EXPECT_EQ(offsetof(ThreadSlot, gate), 504u);
  EXPECT_EQ(offsetof(ThreadSlot, reply), 512u);
  EXPECT_EQ(offsetof(ThreadSlot, signals), 560u);
  EXPECT_EQ(offsetof(ThreadSlot, ipc_notes), 568u);
  EXPECT_EQ(offsetof(ThreadSlot, receipts), 760u);
  EXPECT_EQ(offsetof(ThreadSlot, work), 1168u);
  EXPECT_EQ(offsetof(ThreadSlot, robot), 1196u);
  EXPECT_EQ(offsetof(ThreadSlot, saying), 1200u);
  EXPECT_EQ(offsetof(ThreadSlot, waits_in_call), 1204u);
  EXPECT_EQ(offsetof(ThreadSlot, stopped_tsc), 1208u);
  EXPECT_EQ(offsetof(ThreadSlot, datagrams), 1216u);
  EXPECT_EQ(offsetof(ThreadSlot, announces), 3272u);
  EXPECT_EQ(offsetof(ThreadSlot, descriptors_changed), 3276u);
  EXPECT_EQ(offsetof(ThreadSlot, leads_counter), 3280u);
  EXPECT_EQ(offsetof(ThreadSlot, spin_gap_ns), 3284u);
  EXPECT_EQ(offsetof(ThreadSlot, spin), 3288u);
  EXPECT_EQ(offsetof(ThreadSlot, spin_until_ns), 3320u);
  EXPECT_EQ(offsetof(ThreadSlot, command_ring), 3328u);
  EXPECT_EQ(offsetof(ThreadSlot, interrupted), 5376u);
}

TEST(Layout, TheRunsMemoryIsTheHeaderTheTimesOfSystemVObjectsReceiversAndLocalSockets) {
  EXPECT_EQ(offsetof(RunMemory, ipc_times), 128u);
  EXPECT_EQ(sizeof(RunMemory), 128u + 4096u * 32u);
  EXPECT_EQ(offsetof(PublishedRun, own_receivers), 128u + 4096u * 32u);
  EXPECT_EQ(sizeof(OwnReceivers), 16u + 1024u * 112u);
  EXPECT_EQ(offsetof(PublishedRun, local_sockets), 245904u);
  EXPECT_EQ(sizeof(LocalSockets), 2u * 8192u * 16u);
  EXPECT_EQ(kProcessMemorySize, 4096u * 5696u);
}

TEST(Layout, NothingInItNeedsAConstructorToHaveRun) {
  EXPECT_TRUE(std::is_standard_layout_v<ThreadSlot>);
  EXPECT_TRUE(std::is_trivially_destructible_v<ThreadSlot>);
  EXPECT_NE(kMagic, 0u);
}

}  // namespace
}  // namespace tcs::shm
