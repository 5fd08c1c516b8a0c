#include "shm/local_sockets.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string_view>

namespace tcs::shm {
namespace {

std::uint64_t HashOf(std::string_view path, sa_family_t family = AF_UNIX) {
  sockaddr_un address{};
  address.sun_family = family;
  std::copy(path.begin(), path.end(), address.sun_path);
  return HashOfName(&address, offsetof(sockaddr_un, sun_path) + path.size());
}

TEST(LocalSockets, AreToldByAbstractNamesAlone) {
  using namespace std::literals;
  EXPECT_NE(HashOf("\0drone/imu"sv), 0u);
  EXPECT_EQ(HashOf("\0drone/imu"sv), HashOf("\0drone/imu"sv));
  EXPECT_NE(HashOf("\0drone/imu"sv), HashOf("\0drone/imv"sv));
  EXPECT_NE(HashOf("\0drone/imu"sv), HashOf("\0drone/imu\0"sv)) << "a zero is part of a name";
  EXPECT_EQ(HashOf("/tmp/imu"sv), 0u) << "a file";
  EXPECT_EQ(HashOf(""sv), 0u) << "the kernel is to choose one";
  EXPECT_EQ(HashOf("\0drone/imu"sv, AF_INET), 0u);
}

TEST(LocalSockets, HaveNamesOfTheirRobotWhereEachIsAHostOfItsOwn) {
  using namespace std::literals;
  const std::uint64_t imu = HashOf("\0imu"sv), pose = HashOf("\0pose"sv);
  EXPECT_EQ(NumberOfName(imu, 1, false), NumberOfName(imu, 2, false));
  EXPECT_NE(NumberOfName(imu, 1, true), NumberOfName(imu, 2, true));
  EXPECT_EQ(NumberOfName(imu, 1, true), NumberOfName(imu, 1, true));
  EXPECT_NE(NumberOfName(imu, 1, true), NumberOfName(pose, 1, true));
  EXPECT_EQ(NumberOfName(0, 1, true), 0u) << "a file";
}

TEST(LocalSockets, AreFoundByTheirNumbers) {
  const auto table = std::make_unique<RobotByNumber>();
  EXPECT_EQ(RobotOf(*table, 7), kNoRobot);
  for (std::uint64_t number = 1; number <= RobotByNumber::kMost; ++number) {
    auto* place = PlaceOf(*table, number);
    ASSERT_NE(place, nullptr);
    ASSERT_EQ(place->number.load(), 0u) << number;
    place->robot.store(static_cast<std::uint32_t>(number));
    place->number.store(number);
  }
  for (std::uint64_t number = 1; number <= RobotByNumber::kMost; ++number) {
    ASSERT_EQ(RobotOf(*table, number), number);
  }
  EXPECT_EQ(RobotOf(*table, RobotByNumber::kMost + 1), kNoRobot);
  PlaceOf(*table, 7)->robot.store(kNoRobot);
  EXPECT_EQ(RobotOf(*table, 7), kNoRobot);
}

}  // namespace
}  // namespace tcs::shm
