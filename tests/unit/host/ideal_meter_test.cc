#include "coordinator/host/ideal_meter.h"

#include <gtest/gtest.h>

#include "tests/unit/host/meter_times.h"

namespace tcs {
namespace {

constexpr int kMostLooks = 200;

class IdealMeterTest : public testing::Test {
 protected:
  IdealMeterTest() {
    thread_.page = &page_;
    Dispatch(false);
  }

  void Dispatch(bool is_silent) { page_.base_tsc = meter_.Begin(thread_, 0, true, is_silent); }
  Meter::Found LookTimes(int times) {
    Meter::Found found = Meter::Found::kGoesOn;
    for (int i = 0; i < times; ++i) {
      found = meter_.Look(thread_, 0, OwnTime(kStart + 1000 * kMs), [] { return std::int64_t{0}; });
    }
    return found;
  }

  shm::ClockPage page_{};
  MeteredThread thread_;
  IdealMeter meter_{kMostLooks * FixedMeter::kLookEvery};
};

TEST_F(IdealMeterTest, WhoComputesOnAndOnIsSilent) {
  EXPECT_EQ(LookTimes(kMostLooks - 1), Meter::Found::kGoesOn);
  EXPECT_EQ(LookTimes(1), Meter::Found::kIsSilent);
}

TEST_F(IdealMeterTest, EachDispatchHasItsOwnLooks) {
  EXPECT_EQ(LookTimes(kMostLooks - 1), Meter::Found::kGoesOn);
  Dispatch(false);
  EXPECT_EQ(LookTimes(kMostLooks - 1), Meter::Found::kGoesOn);
}

TEST_F(IdealMeterTest, WhoseRunIsPatientForEverIsNeverSilent) {
  meter_ = IdealMeter(HostDuration::Nanoseconds(INT64_MAX));
  EXPECT_EQ(LookTimes(10 * kMostLooks), Meter::Found::kGoesOn);
}

TEST_F(IdealMeterTest, WhoWasFoundSilentIsLookedAtSoon) {
  Dispatch(true);
  EXPECT_EQ(meter_.TimeToLook(thread_, 0, {}), IdealMeter::kLookAgainEvery);
  EXPECT_EQ(LookTimes(1), Meter::Found::kIsSilent);
}

}  // namespace
}  // namespace tcs
