// What is wrong with what comes over a channel is said, but not a thousand times a second.
#include "coordinator/channel/complaints.h"

#include <gtest/gtest.h>

namespace tcs {
namespace {

TEST(Complaints, AreSaidAtTheFirstTimeAndWheneverThereAreTenTimesAsMany) {
  Complaints complaints;
  testing::internal::CaptureStderr();
  for (int i = 0; i < 250; ++i) complaints.Say("wrench", "no number");
  complaints.Say("other", "no force");
  EXPECT_EQ(testing::internal::GetCapturedStderr(),
            "tcsim: channel wrench: no number\n"
            "tcsim: channel wrench: no number (10 so far)\n"
            "tcsim: channel wrench: no number (100 so far)\n"
            "tcsim: channel other: no force\n");
}

}  // namespace
}  // namespace tcs
