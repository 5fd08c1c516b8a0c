// Which models are near each other, and how far the others may move.
#include "simbody_bridge/model/zones.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace tcs {
namespace {

constexpr double kHorizonS = 0.005;

Mover At(double x, double speed_mps = 0, int group_before = -1, double radius_m = 0.5) {
  static int next = 0;
  const int unit = next++;
  return {{{{x, 0, 0}, radius_m}, speed_mps}, unit, group_before < 0 ? unit : group_before};
}

using Groups = std::vector<std::vector<std::size_t>>;

Groups GroupsOf(const std::vector<Mover>& movers) {
  return Zones(kHorizonS).Group(movers, {}, {}).groups;
}

TEST(Zones, GroupWhoIsNear) {
  EXPECT_EQ(GroupsOf({At(0), At(1.05), At(3)}), (Groups{{0, 1}, {2}}));
  EXPECT_EQ(GroupsOf({At(0), At(2.1), At(1.05)}), (Groups{{0, 1, 2}})) << "by way of a third one";
}

TEST(Zones, GroupWhoComesFast) {
  EXPECT_EQ(GroupsOf({At(0), At(1.5)}).size(), 2u);
  EXPECT_EQ(GroupsOf({At(0), At(1.5, 100)}).size(), 1u);
}

TEST(Zones, LetPartWhoIsFartherThanWhoStaysApart) {
  EXPECT_EQ(GroupsOf({At(0), At(1.15)}).size(), 2u);
  EXPECT_EQ(GroupsOf({At(0, 0, 7), At(1.15, 0, 7)}).size(), 1u);
  EXPECT_EQ(GroupsOf({At(0, 0, 7), At(1.25, 0, 7)}).size(), 2u);
}

TEST(Zones, KeepUnitsTogether) {
  std::vector<Mover> movers = {At(0), At(100)};
  movers[1].unit = movers[0].unit;
  EXPECT_EQ(GroupsOf(movers).size(), 1u);
}

TEST(Zones, GiveWhoIsAloneAllTheRoomAndWhoIsNotLittle) {
  const Grouping grouping = Zones(kHorizonS).Group(std::vector{At(0), At(1.05), At(100)}, {}, {});
  EXPECT_LT(grouping.zones[0].radius_m, 1);
  EXPECT_GT(grouping.zones[2].radius_m, 40);
  const Grouping alone = Zones(kHorizonS).Group(std::vector{At(0)}, {}, {});
  EXPECT_GT(alone.zones[0].radius_m, 1000);
}

// What is static is in the zones of all that are near it, and joins none of them; out of those of
// the others; and whoever brings it along has it anyway.
TEST(Zones, HaveWhatIsStaticInThemOrKeepClearOfIt) {
  std::vector<Mover> movers = {At(-0.1), At(2.5), At(9)};
  for (int i = 0; i < 3; ++i) movers[static_cast<std::size_t>(i)].model = i;
  const std::vector<StaticBall> statics = {{{{1.2, 0, 0}, 0.5}, 7}, {{{9, 0.9, 0}, 0.5}, 2}};
  const Grouping far = Zones(kHorizonS).Group(movers, {}, statics);
  EXPECT_EQ(far.groups, (Groups{{0}, {1}, {2}}));
  EXPECT_EQ(far.bases, (std::vector<std::vector<int>>{{}, {}, {}}));
  EXPECT_LT(far.zones[0].radius_m, 0.75) << "0.3 m are between them";
  EXPECT_GT(far.zones[2].radius_m, 1);
  movers[0].around.ball.center_m[0] = 0.1;
  movers[1].around.ball.center_m[0] = 2.3;
  const Grouping near = Zones(kHorizonS).Group(movers, {}, statics);
  EXPECT_EQ(near.groups.size(), 3u);
  EXPECT_EQ(near.bases, (std::vector<std::vector<int>>{{7}, {7}, {}}));
  EXPECT_GT(near.zones[0].radius_m, 0.8);
}

TEST(Zones, AreNotInTheWayOfWhoIsFar) {
  const Zones zones(kHorizonS);
  const Ball other{{3, 0, 0}, 1};
  EXPECT_FALSE(zones.IsInTheWay(other, At(0)));
  EXPECT_TRUE(zones.IsInTheWay(other, At(1.45)));
  EXPECT_TRUE(zones.IsInTheWay(other, At(0, 300)));
}

// Those of different groups do not overlap, nor the others' zones, with 5 cm around each; and
// nobody leaves its own before the horizon.
TEST(Zones, HaveRoomForEachAndDoNotOverlap) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> place(-6, 6), speed(0, 20), size(0.05, 0.6);
  std::size_t several = 0, alone = 0;
  for (int round = 0; round < 300; ++round) {
    std::vector<Mover> movers;
    for (int i = 0; i < 12; ++i) {
      movers.push_back(At(place(random), speed(random), -1, size(random)));
      movers.back().around.ball.center_m[1] = place(random);
    }
    const Zones zones(kHorizonS);
    std::vector<Ball> others;
    while (others.size() < 3) {
      const Ball other{{place(random), place(random), 3}, 2.4};
      if (std::none_of(movers.begin(), movers.end(),
                       [&](const Mover& of) { return zones.IsInTheWay(other, of); })) {
        others.push_back(other);
      }
    }
    const Grouping grouping = zones.Group(movers, others, {});
    std::vector<std::size_t> group_of(movers.size());
    for (std::size_t g = 0; g < grouping.groups.size(); ++g) {
      (grouping.groups[g].size() > 1 ? several : alone) += 1;
      for (const std::size_t i : grouping.groups[g]) group_of[i] = g;
    }
    for (std::size_t i = 0; i < movers.size(); ++i) {
      EXPECT_GE(TimeToLeave(grouping.zones[i], movers[i].around), kHorizonS * (1 - 1e-9));
      for (std::size_t k = 0; k < i; ++k) {
        if (group_of[i] == group_of[k]) continue;
        EXPECT_GE(GapBetween(grouping.zones[i], grouping.zones[k]), 0.1 - 1e-9);
      }
      for (const Ball& other : others) {
        EXPECT_GE(GapBetween(grouping.zones[i], other), 0.1 - 1e-9);
      }
    }
  }
  EXPECT_GT(several, 200u);
  EXPECT_GT(alone, 300u);
}

}  // namespace
}  // namespace tcs
