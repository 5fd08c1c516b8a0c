#include "coordinator/text/spoken.h"

#include <gtest/gtest.h>

namespace tcs {
namespace {

TEST(Spoken, HasThreeDigits) {
  EXPECT_EQ(Spoken(0), "0 ns");
  EXPECT_EQ(Spoken(999), "999 ns");
  EXPECT_EQ(Spoken(10'000'000), "10 ms");
  EXPECT_EQ(Spoken(15'140'000), "15.1 ms");
  EXPECT_EQ(Spoken(2'050'000'000), "2.05 s");
  EXPECT_EQ(Spoken(153'500), "154 us");
}

}  // namespace
}  // namespace tcs
