// What the line on the terminal says of how long a run will go on.
#include "coordinator/cli/live_line.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tcs {
namespace {

using testing::HasSubstr;
using testing::Not;

constexpr std::int64_t kSecond = 1'000'000'000;

RunProgress At(std::int64_t virtual_ns, std::int64_t real_ns) {
  RunProgress progress;
  progress.virtual_ns = virtual_ns;
  progress.real_ns = real_ns;
  return progress;
}

TEST(LiveLine, SaysNothingOfTheEndAtFirst) {
  LiveLine line(10 * kSecond);
  EXPECT_THAT(line.Text(At(kSecond / 10, kSecond / 5), 200), Not(HasSubstr("to go")));
}

TEST(LiveLine, ReckonsFromHowFastItGoes) {
  LiveLine line(100 * kSecond);
  EXPECT_THAT(line.Text(At(kSecond, 2 * kSecond), 200), HasSubstr("about 3:18 to go"));
}

TEST(LiveLine, FollowsWhatTheRunDoesLately) {
  LiveLine line(100 * kSecond);
  std::string text = line.Text(At(10 * kSecond, 1 * kSecond), 200);
  EXPECT_THAT(text, HasSubstr("about 9 s to go"));
  for (int i = 1; i <= 40; ++i) text = line.Text(At((10 + i) * kSecond, (1 + i) * kSecond), 200);
  EXPECT_THAT(text, HasSubstr("about 50 s to go"));
}

TEST(LiveLine, ShowsTheBusiestFirstAndLeavesOutWhatDoesNotFit) {
  RunProgress progress = At(10 * kSecond, 20 * kSecond);
  progress.clients = {{"robot/controller", kSecond}, {"robot/planner", 5 * kSecond}};
  EXPECT_EQ(LiveLine(100 * kSecond).Text(progress, 10), "10.0 of 10");
  EXPECT_EQ(LiveLine(100 * kSecond).Text(progress, 39), "10.0 of 100.0 virtual s");
  EXPECT_EQ(LiveLine(100 * kSecond).Text(progress, 79),
            "10.0 of 100.0 virtual s  0.50 x real time  about 3:00 to go  robot/planner 50 %");
  EXPECT_THAT(LiveLine(100 * kSecond).Text(progress, 200),
              HasSubstr("robot/controller 10 %  drift 0.000 ms"));
}

}  // namespace
}  // namespace tcs
