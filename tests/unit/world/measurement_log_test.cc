#include "coordinator/world/measurement_log.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <memory>
#include <string>

#include "tests/unit/times.h"

namespace tcs {
namespace {

// Says of everything something that no outlet says by default.
class Telling final : public Outlet {
 public:
  bool Send(const Reading&, VirtualTime) override { return true; }
  VirtualTime NextDue() const override { return AtMs(7); }
  bool HandOver(VirtualTime) override { return true; }
  std::size_t Kept() const override { return 3; }
  std::string WhyUnheard() const override { return "unheard"; }
  std::string WhatWasLost() const override { return "lost"; }
};

TEST(MeasurementLogTest, AnOutletThatIsLoggedSaysWhatItSaidBefore) {
  MeasurementLog log;
  const SensorChannelSpec sensor;
  const auto outlet = log.Wrap(sensor, std::make_unique<Telling>());
  EXPECT_TRUE(outlet->Send({}, {}));
  EXPECT_EQ(outlet->NextDue(), AtMs(7));
  EXPECT_TRUE(outlet->HandOver({}));
  EXPECT_EQ(outlet->Kept(), 3u);
  EXPECT_EQ(outlet->WhyUnheard(), "unheard");
  EXPECT_EQ(outlet->WhatWasLost(), "lost");
}

}  // namespace
}  // namespace tcs
