#include "coordinator/world/sensors.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "coordinator/channel/on_the_way.h"
#include "tests/unit/times.h"

namespace tcs {
namespace {

using testing::ElementsAre;

// Keeps what it is given until it is due, as a socket's outlet does.
class Keeping : public Outlet {
 public:
  bool Send(const Reading& reading, VirtualTime arrives) override {
    on_the_way.Add(std::to_string(reading.at.ns() / 1'000'000), arrives);
    readings.push_back(reading);
    return false;
  }
  VirtualTime NextDue() const override { return on_the_way.NextDue(); }
  bool HandOver(VirtualTime now) override {
    return on_the_way.Arrive(now, [this](const std::string& text) { arrived.push_back(text); });
  }

  OnTheWay on_the_way;
  std::vector<Reading> readings;
  std::vector<std::string> arrived;
};

BodyState ShipAt(double x) { return {.position_m = {x, 0, 0}}; }

class SensorsTest : public testing::Test {
 protected:
  bool ActAt(VirtualTime now) {
    return sensors_.Act(now, [this](int body) { return ShipAt(x_ + body); });
  }

  Keeping outlet_;
  Sensors sensors_;
  double x_ = 0;
};

TEST_F(SensorsTest, WithoutAnyThereIsNothingToDo) {
  EXPECT_EQ(sensors_.NextStop(), VirtualTime::Never());
  EXPECT_EQ(sensors_.NextArrival(), VirtualTime::Never());
  EXPECT_FALSE(ActAt(AtMs(5)));
}

TEST_F(SensorsTest, TheFirstSampleIsAtTimeZero) {
  sensors_.Add({{0, "ship"}}, {Ms(10), {}}, {}, outlet_);
  EXPECT_EQ(sensors_.NextStop(), AtMs(0));
  EXPECT_TRUE(ActAt(AtMs(0)));
  EXPECT_THAT(outlet_.arrived, ElementsAre("0"));
  EXPECT_EQ(sensors_.NextStop(), AtMs(10));
  EXPECT_EQ(sensors_.samples(), 1);
}

TEST_F(SensorsTest, WhatIsReadIsOfTheSampleNotOfItsArrival) {
  sensors_.Add({{1, "ship"}, {0, "rock"}}, {Ms(10), Ms(15)}, {}, outlet_);
  x_ = 7;
  EXPECT_FALSE(ActAt(AtMs(0)));
  EXPECT_EQ(sensors_.NextStop(), AtMs(10));     // to sample,
  EXPECT_EQ(sensors_.NextArrival(), AtMs(15));  // but nothing arrives there
  x_ = 9;
  EXPECT_FALSE(ActAt(AtMs(10)));
  EXPECT_EQ(sensors_.NextStop(), AtMs(15));
  EXPECT_TRUE(ActAt(AtMs(15)));
  EXPECT_THAT(outlet_.arrived, ElementsAre("0"));
  ASSERT_EQ(outlet_.readings[0].bodies.size(), 2u);
  EXPECT_EQ(outlet_.readings[0].bodies[0].name, "ship");
  EXPECT_EQ(outlet_.readings[0].bodies[0].state.position_m[0], 8);
  EXPECT_EQ(outlet_.readings[0].bodies[1].state.position_m[0], 7);
}

TEST_F(SensorsTest, BetweenSamplesNothingHappens) {
  sensors_.Add({{0, "ship"}}, {Ms(10), {}}, {}, outlet_);
  ActAt(AtMs(0));
  EXPECT_FALSE(ActAt(AtMs(9)));
  EXPECT_EQ(sensors_.samples(), 1);
}

TEST_F(SensorsTest, OfSeveralTheNextCounts) {
  Keeping other;
  sensors_.Add({{0, "ship"}}, {Ms(10), {}}, {}, outlet_);
  sensors_.Add({}, {Ms(4), Ms(1)}, {}, other);
  ActAt(AtMs(0));
  EXPECT_EQ(sensors_.NextStop(), AtMs(1));
  EXPECT_EQ(sensors_.NextArrival(), AtMs(1));
  ActAt(AtMs(1));
  EXPECT_EQ(sensors_.NextStop(), AtMs(4));
  EXPECT_EQ(sensors_.NextArrival(), AtMs(5));
}

TEST_F(SensorsTest, ReadsAllJointsOfASensorAtOnce) {
  sensors_.AddJoints({"arm", {7, 3}, {"wrist", "elbow"}}, {Ms(10), {}}, {}, outlet_);
  int calls = 0;
  const auto read_joints = [&](std::span<const int> joints, std::span<JointState> states) {
    ++calls;
    for (std::size_t i = 0; i < joints.size(); ++i) states[i].position = joints[i] * 0.5;
  };
  sensors_.Act(AtMs(0), {}, {.links = {}, .joints = read_joints});
  EXPECT_EQ(calls, 1);
  ASSERT_EQ(outlet_.readings.size(), 1u);
  EXPECT_TRUE(outlet_.readings[0].bodies.empty());
  ASSERT_EQ(outlet_.readings[0].joints.size(), 2u);
  EXPECT_EQ(outlet_.readings[0].joints[0].name, "wrist");
  EXPECT_EQ(outlet_.readings[0].joints[0].state.position, 3.5);
  EXPECT_EQ(outlet_.readings[0].joints[1].state.position, 1.5);
}

}  // namespace
}  // namespace tcs
