#include "coordinator/compare/correction.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tcs::compare {
namespace {

using ::testing::DoubleNear;
using ::testing::ElementsAre;

// As R's p.adjust(method = "holm").
TEST(Correction, IsHolms) {
  EXPECT_THAT(Corrected({0.01, 0.04, 0.03, 0.005}),
              ElementsAre(DoubleNear(0.03, 1e-12), DoubleNear(0.06, 1e-12), DoubleNear(0.06, 1e-12),
                          DoubleNear(0.02, 1e-12)));
}

TEST(Correction, StaysAProbability) {
  EXPECT_THAT(Corrected({0.9, 0.8}), ElementsAre(1, 1));
  EXPECT_TRUE(Corrected({}).empty());
  EXPECT_THAT(Corrected({0.2}), ElementsAre(0.2));
}

}  // namespace
}  // namespace tcs::compare
