#include "coordinator/processes/launches.h"

#include <gtest/gtest.h>

#include "tests/unit/times.h"

namespace tcs {
namespace {

// One robot, and a run of 60 s.
class LaunchesTest : public testing::Test {
 protected:
  static ClientSpec Client(const std::string& name, VirtualDuration start, std::string after = {}) {
    ClientSpec client;
    client.name = name;
    client.start = start;
    client.after = std::move(after);
    return client;
  }
  // Nobody of them starts at 0, which would take a process.
  static Scenario Planned() {
    Scenario scenario;
    RobotSpec& robot = scenario.robots.emplace_back();
    robot.clients = {Client("early", 5 * kSecond), Client("late", 70 * kSecond),
                     Client("next", {}, "early"), Client("much later", 20 * kSecond, "early")};
    return scenario;
  }
  void SetUp() override {
    run_.end = At(60 * kSecond);
    run_.robots.emplace_back("robot", 1.0,
                             RobotScheduler(1, true, [](int) { return RobotScheduler::Wait{}; }));
    ended_.name = "early";
    ended_.is_client = true;
  }
  Robot& robot() { return run_.robots.front(); }

  RunState run_{Planned(), RunOptions{}, false};
  Activations activations_{false};
  Waker waker_{run_, activations_};
  Reactor reactor_;
  World world_{[](const std::string&) {}};
  RunRecords records_{run_, world_, activations_};
  ThreadCreation thread_creation_{run_, waker_, reactor_, records_};
  RegistrationSockets sockets_{reactor_};
  TrapListeners traps_{reactor_};
  const std::vector<pid_t> guarded_;
  RobotNetwork network_;
  Launches launches_{run_, waker_, thread_creation_, sockets_, traps_, world_, network_, guarded_};
  Process ended_;
};

TEST_F(LaunchesTest, TheRobotActsAtTheTimeOfItsNextLaunch) {
  EXPECT_EQ(launches_.Begin(), "");
  EXPECT_EQ(robot().next_launch, At(5 * kSecond));
  EXPECT_TRUE(launches_.AreAhead());
}

TEST_F(LaunchesTest, NothingIsAheadThatIsToStartAfterTheRunsEnd) {
  EXPECT_EQ(launches_.Begin(), "");
  run_.end = At(5 * kSecond);
  EXPECT_FALSE(launches_.AreAhead());
}

TEST_F(LaunchesTest, WhoWaitsForAnotherOneStartsWhenThatHasEndedButNotBeforeItIsTo) {
  EXPECT_EQ(launches_.Begin(), "");
  ended_.ended_at = At(3 * kSecond);
  launches_.ClientHasEnded(ended_);
  EXPECT_EQ(robot().next_launch, At(3 * kSecond));
  EXPECT_EQ(launches_.all()[2].start, At(3 * kSecond));
  EXPECT_EQ(launches_.all()[3].start, At(20 * kSecond));
}

TEST_F(LaunchesTest, NobodyStartsInTheGrace) {
  EXPECT_EQ(launches_.Begin(), "");
  run_.grace_began = At(4 * kSecond);
  launches_.Stop();
  ended_.ended_at = At(4 * kSecond);
  launches_.ClientHasEnded(ended_);
  EXPECT_FALSE(launches_.AreAhead());
}

}  // namespace
}  // namespace tcs
