#include "coordinator/errors/nearest.h"

#include <gtest/gtest.h>

namespace tcs {
namespace {

const std::vector<std::string> kKeys = {"mass", "inertia", "linear_velocity"};

TEST(Nearest, ForgivesSlipsOfTheFingers) {
  EXPECT_EQ(Nearest("mas", kKeys), "mass");
  EXPECT_EQ(Nearest("Mass", kKeys), "mass");
  EXPECT_EQ(Nearest("inetria", kKeys), "inertia");
  EXPECT_EQ(Nearest("linear-velocity", kKeys), "linear_velocity");
  EXPECT_EQ(Nearest("liner_velocty", kKeys), "linear_velocity");
}

TEST(Nearest, TakesTheNearestOfSeveral) {
  EXPECT_EQ(Nearest("prey2", {"prey1", "prey22", "prey"}), "prey1");
  EXPECT_EQ(Nearest("class", {"clash", "class_"}), "clash");
}

TEST(Nearest, DoesNotGuessWildly) {
  EXPECT_EQ(Nearest("colour", kKeys), std::nullopt);
  EXPECT_EQ(Nearest("x", {"y"}), std::nullopt);
  EXPECT_EQ(Nearest("", kKeys), std::nullopt);
  EXPECT_EQ(Nearest(std::string(10'000, 'm'), kKeys), std::nullopt);
}

TEST(Suggest, ListsWhatIsKnownWhereNothingIsNear) {
  EXPECT_EQ(Suggest("mas", kKeys, "keys"), "did you mean 'mass'?");
  EXPECT_EQ(Suggest("colour", kKeys, "keys"),
            "the keys here are mass, inertia and linear_velocity");
}

}  // namespace
}  // namespace tcs
