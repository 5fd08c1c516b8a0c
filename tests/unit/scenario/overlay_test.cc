// --overlay FILE: values of one file in another one's stead.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "coordinator/scenario/load.h"
#include "tests/unit/scenario/scenario_folder.h"

namespace tcs {
namespace {

using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;
using testing::StartsWith;

class OverlayTest : public testing::Test {
 protected:
  LoadResult<Scenario> Result(std::string_view overlay,
                              const std::vector<std::string>& set = {}) const {
    const std::string path = folder_.Write("costs.yaml", overlay);
    return LoadScenario(folder_.Write("s.yaml", kGoodScenario), {.overlays = {path}, .set = set});
  }
  Scenario Load(std::string_view overlay, const std::vector<std::string>& set = {}) const {
    return ScenarioOf(Result(overlay, set));
  }
  std::string Complaint(std::string_view overlay) const {
    return tcs::Complaint(folder_, Result(overlay));
  }

  const ScenarioFolder folder_;
};

TEST_F(OverlayTest, ReplacesWhatItSaysAndLeavesTheRest) {
  const Scenario scenario = Load(R"(# costs
duration: 3s
robots:
  hunter:
    clients:
      "controller": {fixed_call_cost: 700ns, fixed_allocation_cost: 9us}
)");
  EXPECT_EQ(scenario.duration, VirtualDuration::Seconds(3));
  const ClientSpec& controller = scenario.robots[0].clients[0];
  EXPECT_EQ(controller.fixed_call_cost, VirtualDuration::Nanoseconds(700));
  EXPECT_EQ(controller.fixed_allocation_cost, VirtualDuration::Microseconds(9));
  EXPECT_EQ(controller.client_class, ClientClass::kPeriodic);
  EXPECT_THAT(scenario.set,
              ElementsAre("duration=3s", "robots.hunter.clients.controller.fixed_call_cost=700ns",
                          "robots.hunter.clients.controller.fixed_allocation_cost=9us"));
}

TEST_F(OverlayTest, SetComesAfterIt) {
  EXPECT_EQ(Load("duration: 3s\n", {"duration=4s"}).duration, VirtualDuration::Seconds(4));
}

TEST_F(OverlayTest, ListsAndTextsAreReplacedWholeAndNullRemoves) {
  const Scenario scenario = Load(
      "robots: {hunter: {clients: {controller: {command: [sh, -c, \"a: 'b' # c\"], "
      "priority: null}}}}\n");
  const ClientSpec& controller = scenario.robots[0].clients[0];
  EXPECT_THAT(controller.command, ElementsAre(EndsWith("/sh"), "-c", "a: 'b' # c"));
  EXPECT_EQ(controller.priority, 0);
}

TEST_F(OverlayTest, AnEmptyOneChangesNothing) {
  for (const char* nothing : {"", "# nothing\n", "{}", "robots: {}"}) {
    EXPECT_TRUE(Load(nothing).set.empty());
  }
}

TEST_F(OverlayTest, WhatItNamesMustBeThere) {
  EXPECT_THAT(Complaint("robots:\n  hunter:\n    clients:\n      planer: {fixed_call_cost: 1us}\n"),
              StartsWith("costs.yaml:4: there is no 'planer' in robots.hunter.clients; "));
  EXPECT_THAT(Complaint("robots:\n  wolf:\n    clients: {c: {fixed_call_cost: 1us}}\n"),
              StartsWith("costs.yaml:3: there is no 'wolf' in robots; "));
  EXPECT_THAT(Complaint("\nrobots:\n  hunter: {clients: {controller: {fixed_cal_cost: 1us}}}\n"),
              StartsWith("costs.yaml:3: unknown key 'fixed_cal_cost'"));
  EXPECT_THAT(Complaint("robots:\n  hunter: {clients: {controller: {fixed_call_cost: 0}}}\n"),
              StartsWith("costs.yaml:2: robots.hunter.clients.controller.fixed_call_cost"));
}

TEST_F(OverlayTest, WhatIsNoPieceOfAScenarioIsSaid) {
  EXPECT_THAT(Complaint("- 1\n"), HasSubstr("costs.yaml:1: this is no piece of a scenario"));
  EXPECT_THAT(Complaint("a: b: c\n"), HasSubstr("costs.yaml:1: this is not valid YAML"));
  EXPECT_THAT(Complaint("? [a]\n: b\n"), HasSubstr("this key is not a text"));
  EXPECT_THAT(Complaint("a: &a {b: *a}\n"), HasSubstr("costs.yaml:1: "));
  const auto missing =
      LoadScenario(folder_.Write("s.yaml", kGoodScenario), {.overlays = {"/nonexistent.yaml"}});
  ASSERT_TRUE(std::holds_alternative<LoadError>(missing));
  EXPECT_THAT(std::get<LoadError>(missing).message,
              HasSubstr("/nonexistent.yaml: cannot be read: No such file"));
}

}  // namespace
}  // namespace tcs
