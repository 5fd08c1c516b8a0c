#include "coordinator/prices/price_list.h"

#include <gtest/gtest.h>

namespace tcs {
namespace {

constexpr VirtualDuration Us(std::int64_t us) { return VirtualDuration::Microseconds(us); }

TEST(PriceBySizeTest, IsALineThroughWhatWasMeasured) {
  const PriceBySize price({Us(10), Us(12), Us(75), Us(1035)});
  EXPECT_EQ(price.Of(0), Us(10));
  EXPECT_EQ(price.Of(512), Us(11));
  EXPECT_EQ(price.Of(1024), Us(12));
  EXPECT_EQ(price.Of(1024 + 2 * 1024), Us(14));  // 63 KB are 63 us
  EXPECT_EQ(price.Of(65536), Us(75));
  EXPECT_EQ(price.Of(1 << 20), Us(1035));
  EXPECT_EQ(price.Of((1 << 20) + 960 * 1024), Us(1995));  // and so on behind the last
}

TEST(PriceBySizeTest, IsNeverNegative) {
  const PriceBySize price({Us(1), Us(1), Us(1000), Us(0)});
  EXPECT_EQ(price.Of(std::size_t{1} << 30), VirtualDuration());
}

TEST(PriceListTest, AFasterComputerTakesLess) {
  PriceList list = NoPrices();
  list.dds_reliable.send = PriceBySize({Us(10), Us(20), Us(30), Us(40)});
  list.dds_computed.receive = PriceBySize({Us(4), Us(4), Us(4), Us(4)});
  const PriceList faster = list.On(2);
  EXPECT_EQ(faster.Dds(true).send.Of(0), Us(5));
  EXPECT_EQ(faster.Dds(true).send.Of(65536), Us(15));
  EXPECT_EQ(faster.dds_computed.receive.Of(7), Us(2));
  EXPECT_EQ(faster.Dds(false).send.Of(0), VirtualDuration());
  EXPECT_EQ(faster.name, list.name);
}

TEST(PriceListTest, TheHashIsOfTheTimes) {
  PriceList list = ShippedPrices();
  const std::uint64_t hash = list.Hash();
  list.name = "the same";
  EXPECT_EQ(list.Hash(), hash);
  PriceBySize::Times times = list.dds_best_effort.receive.times();
  times[3] += VirtualNs(1);
  list.dds_best_effort.receive = PriceBySize(times);
  EXPECT_NE(list.Hash(), hash);
}

// What is spared is most of what is natively taken, and more for more bytes.
TEST(PriceListTest, WhatIsShippedHasPricesOfEachKind) {
  const PriceList list = ShippedPrices();
  for (const bool is_reliable : {true, false}) {
    const DdsPrices& dds = list.Dds(is_reliable);
    for (const PriceBySize* price : {&dds.send, &dds.send_further, &dds.receive}) {
      for (std::size_t i = 1; i < PriceBySize::kSizes.size(); ++i) {
        EXPECT_GE(price->times()[i], price->times()[i - 1]);
      }
      EXPECT_GT(price->times()[0], VirtualDuration());
    }
  }
  EXPECT_EQ(NoPrices().Dds(true).receive.Of(1 << 20), VirtualDuration());
}

}  // namespace
}  // namespace tcs
