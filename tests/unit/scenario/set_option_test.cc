// --set KEY=VALUE in the scenario's stead.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "coordinator/scenario/load.h"
#include "tests/unit/scenario/scenario_folder.h"

namespace tcs {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

class SetTest : public testing::Test {
 protected:
  LoadResult<Scenario> Result(std::string_view text, const std::vector<std::string>& set) const {
    return LoadScenario(folder_.Write("s.yaml", text), {.set = set});
  }
  Scenario Load(std::string_view text, const std::vector<std::string>& set) const {
    return ScenarioOf(Result(text, set));
  }
  Scenario Load(const std::vector<std::string>& set) const { return Load(kGoodScenario, set); }

  std::string Complaint(std::string_view text, const std::vector<std::string>& set) const {
    return tcs::Complaint(folder_, Result(text, set));
  }
  std::string Complaint(const std::vector<std::string>& set) const {
    return Complaint(kGoodScenario, set);
  }

 private:
  const ScenarioFolder folder_;
};

TEST_F(SetTest, ReplacesAValueAndLeavesTheRestAlone) {
  const Scenario scenario = Load({"robots.hunter.cpu.speed=0.25", "duration=3s", "seed=9"});
  EXPECT_EQ(scenario.robots[0].speed, 0.25);
  EXPECT_EQ(scenario.robots[0].cores, 4);
  EXPECT_EQ(scenario.robots[0].clients[0].name, "hunter/controller");
  EXPECT_EQ(scenario.duration, VirtualDuration::Seconds(3));
  EXPECT_EQ(scenario.robots[0].clients[0].command[2], "9") << "${seed} is the one that was set";
  EXPECT_THAT(scenario.set, ElementsAre("robots.hunter.cpu.speed=0.25", "duration=3s", "seed=9"));
}

TEST_F(SetTest, AddsKeysAndTheMapsAboveThem) {
  const Scenario scenario = Load(WithReplaced("  region: {half_extent: 12, stiffness: 40, "
                                              "damping: 0.5}\n",
                                              ""),
                                 {"dynamics.region.stiffness=70", "dynamics.region.half_extent=3",
                                  "robots.hunter.clients.planner.environment.MODE=slow"});
  EXPECT_TRUE(scenario.world->has_region);
  EXPECT_EQ(scenario.world->region.stiffness_npm, 70);
  EXPECT_EQ(scenario.world->region.half_extent_m, 3);
  EXPECT_EQ(scenario.robots[0].clients[1].environment.at("MODE"), "slow");
}

TEST_F(SetTest, ReadsTheValueAsYaml) {
  const Scenario scenario =
      Load({"robots.hunter.clients.planner.command=[sh, -c, \"exit 3\", --budget, \"0.5\"]",
            "bodies.rock={mass: 4, inertia: [1, 1, 1]}"});
  EXPECT_THAT(scenario.robots[0].clients[1].command,
              ElementsAre(testing::EndsWith("/sh"), "-c", "exit 3", "--budget", "0.5"));
  ASSERT_EQ(scenario.world->bodies.size(), 3u);
  EXPECT_EQ(scenario.world->bodies[2].name, "rock");
}

TEST_F(SetTest, CountsElementsOfListsFromZero) {
  const Scenario scenario =
      Load({"robots.hunter.clients.controller.command.1=--start",
            "robots.hunter.clients.controller.command[2]=5",
            "robots.hunter.clients.controller.command.3=more", "bodies.predator.position[2]=7"});
  EXPECT_THAT(scenario.robots[0].clients[0].command,
              ElementsAre(testing::_, "--start", "5", "more"));
  EXPECT_THAT(scenario.world->bodies[0].initial.position_m, ElementsAre(-5, 0, 7));
}

TEST_F(SetTest, RemovesAKeyOrAnElementByNull) {
  const Scenario scenario =
      Load({"dynamics.integrator=null", "dynamics.accuracy=null", "dynamics.engine=ode",
            "robots.hunter.clients.planner=null", "robots.hunter.clients.controller.command[1]=~"});
  EXPECT_EQ(scenario.world->integrator.engine, EngineKind::kOde);
  EXPECT_EQ(scenario.robots[0].clients.size(), 1u);
  EXPECT_THAT(scenario.robots[0].clients[0].command, ElementsAre(testing::_, "7"));
}

TEST_F(SetTest, TheLastOneWinsButForTheOptionsOfTheirOwn) {
  EXPECT_EQ(Load({"seed=8", "seed=9"}).seed, 9u);
  const ScenarioFolder folder;
  const auto result = LoadScenario(folder.Write("s.yaml", kGoodScenario),
                                   {.set = {"seed=9", "duration=5s"}, .seed = 10});
  EXPECT_EQ(std::get<Scenario>(result).seed, 10u);
  EXPECT_EQ(std::get<Scenario>(result).duration, VirtualDuration::Seconds(5));
}

TEST_F(SetTest, LaterOnesReachIntoEarlierOnes) {
  const Scenario scenario = Load({"dynamics={engine: ode}", "dynamics.step=2ms"});
  EXPECT_EQ(scenario.world->integrator.engine, EngineKind::kOde);
  EXPECT_EQ(scenario.world->integrator.fixed_step, VirtualDuration::Milliseconds(2));
}

// "a", "a.b" and "a.b.c" are names all three.
constexpr std::string_view kDottedNames =
    "duration: 1s\n"
    "robots:\n"
    "  a: {cpu: {speed: 1}, clients: {c: {command: [sh]}, c.d: {command: [sh]}}}\n"
    "  a.b: {cpu: {speed: 1}, clients: {c: {command: [sh]}}}\n"
    "  a.b.c: {clients: {x.y: {command: [sh]}}}\n";

TEST_F(SetTest, FindsNamesWithDots) {
  const Scenario scenario = Load(
      kDottedNames, {"robots.a.cpu.speed=2", "robots.a.b.cpu.speed=3", "robots.a.b.c.cpu.speed=4",
                     "robots.a.clients.c.priority=5", "robots.a.clients.c.d.priority=6",
                     "robots.a.b.c.clients.x.y.priority=7"});
  EXPECT_EQ(scenario.robots[0].speed, 2);
  EXPECT_EQ(scenario.robots[1].speed, 3);
  EXPECT_EQ(scenario.robots[2].speed, 4);
  EXPECT_EQ(scenario.robots[0].clients[0].priority, 5);
  EXPECT_EQ(scenario.robots[0].clients[1].priority, 6);
  EXPECT_EQ(scenario.robots[2].clients[0].priority, 7);
}

TEST_F(SetTest, ChangesOneOfTwoThatShareAnAnchor) {
  const Scenario scenario = Load(
      "duration: 1s\nrobots:\n"
      "  a: {cpu: &slow {speed: 0.5}, clients: {c: {command: [sh]}}}\n"
      "  b: {cpu: *slow, clients: {c: {command: [sh]}}}\n",
      {"robots.b.cpu.speed=2"});
  EXPECT_EQ(scenario.robots[0].speed, 0.5);
  EXPECT_EQ(scenario.robots[1].speed, 2);
}

TEST_F(SetTest, MistakesInAValueNameTheOption) {
  EXPECT_EQ(Complaint({"bodies.predator.mass=-1"}),
            "--set bodies.predator.mass=-1: bodies.predator.mass is -1; it must be positive "
            "(kilograms)");
  EXPECT_EQ(Complaint({"bodies.predator.position=[1, x, 3]"}),
            "--set bodies.predator.position=[1, x, 3]: bodies.predator.position[1] is 'x'; it must "
            "be a finite number");
  EXPECT_EQ(Complaint({"bodies.predator.position.1=x"}),
            "--set bodies.predator.position.1=x: bodies.predator.position[1] is 'x'; it must be a "
            "finite number");
  EXPECT_EQ(Complaint({"dynamics.engine=odd", "dynamics.integrator=null"}),
            "--set dynamics.engine=odd: dynamics.engine is the unknown 'odd'; did you mean 'ode'?");
  EXPECT_THAT(Complaint({"bodies.rock={mass: 4}"}),
              StartsWith("--set bodies.rock={mass: 4}: bodies.rock lacks the key 'inertia'"));
  EXPECT_THAT(Complaint({"bodies={a: {mass: 4}}", "bodies.a.mass=5"}),
              StartsWith("--set bodies={a: {mass: 4}}: bodies.a lacks the key 'inertia'"));
  EXPECT_THAT(Complaint({"robots.hunter.clients.planner.command.0=./nobody"}),
              StartsWith("--set robots.hunter.clients.planner.command.0=./nobody: "));
  EXPECT_THAT(Complaint({"channels.hands.commands.listen=127.0.0.1:47010"}),
              HasSubstr("again, which is that of channels.eyes.sensors.to on line 32; "));
  EXPECT_THAT(Complaint({"channels.eyes.sensors.to=127.0.0.1:47011"}),
              AllOf(StartsWith("s.yaml:35: "),
                    HasSubstr("sensors.to by --set channels.eyes.sensors.to=127.0.0.1:47011; ")));
}

TEST_F(SetTest, MistakesInTheFileStillNameTheLine) {
  EXPECT_THAT(Complaint(WithReplaced("mass: 1.5", "mass: -1.5"),
                        {"bodies.predator.position=[1, 2, 3]", "name=other"}),
              StartsWith("s.yaml:13: bodies.predator.mass is -1.5"));
  EXPECT_THAT(Complaint({"dynamics.engine=ode"}),
              StartsWith("s.yaml:7: dynamics.integrator is Simbody's"));
  EXPECT_THAT(Complaint({"bodies.prey.mass=null"}), StartsWith("s.yaml:16: bodies.prey lacks"));
}

TEST_F(SetTest, UnknownPathsAskWhatWasMeant) {
  EXPECT_EQ(Complaint({"dynamics.engin=ode"}),
            "--set dynamics.engin=ode: unknown key 'engin' in dynamics; did you mean 'engine'?");
  EXPECT_EQ(Complaint({"dynamcs.engine=ode"}),
            "--set dynamcs.engine=ode: unknown key 'dynamcs'; did you mean 'dynamics'?");
  EXPECT_EQ(
      Complaint({"robots.huntr.cpu.speed=2"}),
      "--set robots.huntr.cpu.speed=2: there is no 'huntr' in robots; did you mean 'hunter'?");
  EXPECT_EQ(Complaint({"robots.hunter.clients.planer.priority=2"}),
            "--set robots.hunter.clients.planer.priority=2: there is no 'planer' in "
            "robots.hunter.clients; did you mean 'planner'?");
  EXPECT_EQ(Complaint({"bodies.prei=null"}),
            "--set bodies.prei=null: there is no 'prei' in bodies; did you mean 'prey'?");
  EXPECT_EQ(Complaint({"duration.seconds=4"}),
            "--set duration.seconds=4: duration has no keys or elements; end the key there");
  EXPECT_EQ(Complaint({"robots.hunter.clients.controller.command.9=x"}),
            "--set robots.hunter.clients.controller.command.9=x: "
            "robots.hunter.clients.controller.command is a list of 3; write "
            "robots.hunter.clients.controller.command.0 for its first element, or .3 for one more");
  EXPECT_THAT(Complaint({"bodies.predator.position.x=1"}), HasSubstr("is a list of 3; write "));
}

TEST_F(SetTest, WhatIsNoKeyAndValueSaysSo) {
  EXPECT_EQ(Complaint({"dynamics.step"}),
            "--set dynamics.step: this is not KEY=VALUE; write it like --set dynamics.step=1ms");
  EXPECT_EQ(Complaint({"=3"}),
            "--set =3: this is not KEY=VALUE; write it like --set "
            "dynamics.step=1ms");
  EXPECT_EQ(Complaint({"seed="}),
            "--set seed=: there is no value; write KEY=VALUE, or KEY=null to remove the key");
  EXPECT_EQ(Complaint({"seed. =4"}),
            "--set seed. =4: seed has no keys or elements; end the key there");
  EXPECT_EQ(Complaint({"dynamics.=4"}),
            "--set dynamics.=4: 'dynamics.' ends with '.'; say what follows");
  EXPECT_EQ(Complaint({"dynamics..step=4"}),
            "--set dynamics..step=4: 'dynamics..step' is not a key path: a key is missing in it");
  EXPECT_THAT(Complaint({"bodies.predator.position=[1, 2"}),
              AllOf(StartsWith("--set bodies.predator.position=[1, 2: the value is not valid YAML"),
                    HasSubstr("quote a text")));
  EXPECT_THAT(Complaint({"name=[a,\nb]"}), StartsWith("--set name=[a, b]: name is a list"));
}

}  // namespace
}  // namespace tcs
