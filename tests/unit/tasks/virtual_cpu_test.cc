#include <gtest/gtest.h>

#include "coordinator/tasks/task.h"

namespace tcs {
namespace {

TEST(VirtualCpu, ComesFurtherOnly) {
  Robot robot("prey", 1.0, RobotScheduler(1, false, [](RobotScheduler::Thread) {
                return RobotScheduler::Wait{};
              }));
  VirtualCpu cpu{.robot = &robot};
  cpu.ComeTo(RobotTime(500));
  cpu.ComeTo(RobotTime(500));
  EXPECT_EQ(cpu.progress, RobotTime(500));
  EXPECT_DEATH(cpu.ComeTo(RobotTime(499)), "a bug in tcs");
}

}  // namespace
}  // namespace tcs
