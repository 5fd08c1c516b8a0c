// What a scenario expects: bounds, and what is said of what there is not.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "coordinator/scenario/load.h"
#include "tests/unit/scenario/scenario_folder.h"

namespace tcs {
namespace {

using testing::AllOf;
using testing::HasSubstr;

constexpr std::string_view kExpecting = R"(duration: 1s
dynamics: {}
bodies:
  drone: {mass: 1, inertia: [1, 1, 1]}
robots: {hover: {clients: {controller: {command: [./controller]}, planner: {command: [./controller]}}}}
channels:
  eyes: {type: udp_json, sensors: {bodies: [drone], to: "127.0.0.1:47001"}}
  push: {type: udp_json, commands: {body: drone, listen: "127.0.0.1:47004"}}
metrics:
  height_error: {rms: drone.z - 1.0}
expect:
)";

class LoadExpectTest : public testing::Test {
 protected:
  Scenario Loaded(const std::string& expect) const {
    return ScenarioOf(LoadScenario(folder_.Write("s.yaml", std::string(kExpecting) + expect)));
  }
  std::string Refusal(const std::string& expect) const {
    return Complaint(folder_, std::string(kExpecting) + expect);
  }
  const ScenarioFolder folder_;
};

TEST_F(LoadExpectTest, TakesTheMostOrAPair) {
  const Scenario scenario =
      Loaded(R"(  hover/controller: {misses: 0, response_p99: 5ms, share: 0.95}
  planner: {activations: [10, null], missed: [null, 0.1]}
  chain eyes->push: {age_p99: [1ms, 50ms]}
  metric height_error: {rms: 0.05}
  metric hover/planner/time: {max: 2}
  run: {virtual: 20s}
)");
  const auto& all = scenario.expectations;
  ASSERT_EQ(all.size(), 8U);
  EXPECT_EQ(all[0].measure, "hover/controller.misses");
  EXPECT_EQ(all[0].most, 0);
  EXPECT_TRUE(std::isinf(all[0].least));
  EXPECT_EQ(all[0].share, 0.95);
  EXPECT_EQ(all[1].most, 0.005);
  EXPECT_EQ(all[2].measure, "hover/planner.activations");
  EXPECT_EQ(all[2].least, 10);
  EXPECT_TRUE(std::isinf(all[2].most));
  EXPECT_EQ(all[4].measure, "chain eyes->push.age_p99");
  EXPECT_EQ(all[4].least, 0.001);
  EXPECT_EQ(all[5].measure, "height_error.rms");
  EXPECT_EQ(all[6].measure, "hover/planner/time.max");
  EXPECT_EQ(all[7].measure, "run.virtual");
  EXPECT_THAT(all[7].place, HasSubstr("s.yaml:17: "));
}

TEST_F(LoadExpectTest, LooksAtBodiesAllTheWhile) {
  const Scenario scenario = Loaded(R"(  body drone: {z: [0.9, 1.1], vx: 2, from: 0.5s, every: 1ms}
  channel push: {force_z: [-1, 1]}
)");
  ASSERT_EQ(scenario.kept.size(), 3U);
  EXPECT_EQ(scenario.expectations[1].kept, 1U);
  EXPECT_EQ(scenario.kept[0].least, 0.9);
  EXPECT_EQ(scenario.kept[0].most, 1.1);
  EXPECT_EQ(scenario.kept[0].from, VirtualDuration::Milliseconds(500));
  EXPECT_EQ(scenario.kept[1].every, VirtualDuration::Milliseconds(1));
  EXPECT_EQ(scenario.metrics.size(), 1U);
  EXPECT_EQ(scenario.quantities.size(), 3U + 1U);
}

TEST_F(LoadExpectTest, NamesTheNearestOfWhatThereIsNot) {
  EXPECT_THAT(Refusal("  hover/contrller: {misses: 0}\n"),
              AllOf(HasSubstr("s.yaml:12: "), HasSubstr("did you mean 'hover/controller'?")));
  EXPECT_THAT(Refusal("  hover/controller: {mises: 0}\n"), HasSubstr("did you mean 'misses'?"));
  EXPECT_THAT(Refusal("  body dron: {z: 1}\n"), HasSubstr("did you mean 'drone'?"));
  EXPECT_THAT(Refusal("  body drone: {rol: 1}\n"), HasSubstr("did you mean 'roll'?"));
  EXPECT_THAT(Refusal("  chain eye->push: {age_p99: 1s}\n"),
              HasSubstr("did you mean 'eyes->push'?"));
  EXPECT_THAT(Refusal("  metric heigth_error: {rms: 1}\n"),
              HasSubstr("did you mean 'height_error'?"));
  EXPECT_THAT(Refusal("  bdy drone: {z: 1}\n"), HasSubstr("did you mean 'body'?"));
  EXPECT_THAT(Refusal("  joint drone: {velocity: 1}\n"), HasSubstr("drone.velocity"));
  EXPECT_THAT(Refusal("  channel drone: {z: 1}\n"), HasSubstr("no quantity of a channel"));
}

TEST_F(LoadExpectTest, RefusesBoundsThatAreNone) {
  EXPECT_THAT(Refusal("  body drone: {z: [1, 0]}\n"), HasSubstr("swap them"));
  EXPECT_THAT(Refusal("  body drone: {z: [1, 0, 2]}\n"), HasSubstr("has 3 limits"));
  EXPECT_THAT(Refusal("  body drone: {z: [null, null]}\n"), HasSubstr("has no limit"));
  EXPECT_THAT(Refusal("  body drone: {z: low}\n"), HasSubstr("must be a finite number"));
  EXPECT_THAT(Refusal("  body drone: {from: 1s}\n"), HasSubstr("expects nothing"));
  EXPECT_THAT(Refusal("  hover/controller: {}\n"), HasSubstr("expects nothing"));
  EXPECT_THAT(Refusal("  hover/controller: {response_p99: soon}\n"), HasSubstr("s.yaml:12: "));
  EXPECT_THAT(Refusal("  hover/controller: {misses: 0, share: 2}\n"), HasSubstr("is more than 1"));
  EXPECT_THAT(Refusal("  body drone: {z: 1, from: 2ms, until: 1ms}\n"),
              HasSubstr("is before from"));
}

TEST_F(LoadExpectTest, WarnsOfWhatCannotHold) {
  const Scenario scenario = Loaded("  body drone: {z: 1, from: 2s}\n");
  ASSERT_EQ(scenario.warnings.size(), 1U);
  EXPECT_THAT(scenario.warnings[0], HasSubstr("begins after the end of the run"));
}

TEST_F(LoadExpectTest, DoesNotJudgeWhatBeginsAfterTheEndThatWasAskedFor) {
  const std::string expect = "  body drone: {z: 1, vz: 1, from: 600ms}\n  run: {drift: 1ms}\n";
  ScenarioOverrides overrides;
  overrides.duration = VirtualDuration::Milliseconds(500);
  const Scenario shorter = ScenarioOf(
      LoadScenario(folder_.Write("s.yaml", std::string(kExpecting) + expect), overrides));
  EXPECT_EQ(shorter.expectations.size(), 1U);
  EXPECT_EQ(shorter.not_judged, 2U);
  EXPECT_THAT(shorter.warnings, testing::IsEmpty());
  overrides.duration = VirtualDuration::Milliseconds(600);  // there is one value
  const Scenario until_then = ScenarioOf(LoadScenario(folder_.path() + "/s.yaml", overrides));
  EXPECT_EQ(until_then.expectations.size(), 3U);
  EXPECT_EQ(until_then.not_judged, 0U);
}

}  // namespace
}  // namespace tcs
