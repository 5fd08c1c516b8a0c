#include "coordinator/world/due_links.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "coordinator/world/instruments/instrument.h"
#include "tests/unit/times.h"

namespace tcs {
namespace {

using testing::ElementsAre;

RobotModel Falling(const std::string& name, double height_m) {
  Link link;
  link.name = name;
  link.inertial = Inertial{.mass_kg = 1, .frame = {}, .ixx_kgm2 = 1, .iyy_kgm2 = 1, .izz_kgm2 = 1};
  RobotModel model;
  model.name = name;
  model.links.push_back(link);
  model.at.position_m = {0, 0, height_m};
  return model;
}

class Nowhere : public Outlet {
 public:
  bool Send(const Reading&, VirtualTime) override { return false; }
  VirtualTime NextDue() const override { return VirtualTime::Never(); }
  bool HandOver(VirtualTime) override { return false; }
};

class DueLinksTest : public testing::Test {
 protected:
  DueLinksTest() {
    world_.gravity_mps2 = {0, 0, -10};
    world_.models = {Falling("low", 10), Falling("middle", 20), Falling("high", 30)};
    dynamics_ = MakeDynamics(world_);
  }
  void Look(int link, std::int64_t period_ms) {
    const VirtualDuration period = VirtualDuration::Milliseconds(period_ms);
    sensors_.AddInstrument(MakeInstrument(TruthSpec{.mount = {.link = link}}, period, world_),
                           {.period = period, .latency = {}}, {}, {}, nowhere_);
  }
  // What they see, and which links they ask for.
  std::vector<int> ActAt(VirtualTime now) {
    dynamics_->AdvanceTo(now);
    due_links_.Read(sensors_, now, *dynamics_);
    std::vector<int> asked;
    sensors_.Act(now, {},
                 {.links =
                      [&](std::span<const int> links, std::span<LinkState> states) {
                        due_links_.Give(links, states);
                        for (std::size_t i = 0; i < links.size(); ++i) {
                          LinkState alone;
                          dynamics_->ReadLinks(now, {&links[i], 1}, {&alone, 1});
                          EXPECT_EQ(states[i].pose, alone.pose);
                          EXPECT_EQ(states[i].linear_velocity_mps, alone.linear_velocity_mps);
                          asked.push_back(links[i]);
                        }
                      },
                  .joints = {}});
    return asked;
  }

  WorldSpec world_;
  std::unique_ptr<Dynamics> dynamics_;
  Nowhere nowhere_;
  Sensors sensors_;
  DueLinks due_links_;
};

TEST_F(DueLinksTest, AreAllThatSensorsLookAtInTheInstant) {
  Look(2, 10);
  Look(0, 20);
  Look(2, 20);
  EXPECT_THAT(ActAt(AtMs(0)), ElementsAre(2, 0, 2));
  EXPECT_THAT(ActAt(AtMs(10)), ElementsAre(2));
  EXPECT_THAT(ActAt(AtMs(20)), ElementsAre(2, 0, 2));
}

TEST_F(DueLinksTest, NoOthersAreRead) {
  Look(0, 10);
  dynamics_->AdvanceTo(AtMs(10));
  const std::int64_t before = dynamics_->work().steps;
  due_links_.Read(sensors_, AtMs(10), *dynamics_);
  const std::int64_t one = dynamics_->work().steps - before;
  LinkState other;
  const int link = 1;
  dynamics_->ReadLinks(AtMs(10), {&link, 1}, {&other, 1});
  EXPECT_GT(one, 0);
  EXPECT_GT(dynamics_->work().steps, before + one);
}

TEST_F(DueLinksTest, WhatIsNotDueIsNotGiven) {
  Look(0, 10);
  ActAt(AtMs(0));
  LinkState state;
  const int link = 1;
  EXPECT_DEATH(due_links_.Give({&link, 1}, {&state, 1}), "a bug in tcs");
}

}  // namespace
}  // namespace tcs
