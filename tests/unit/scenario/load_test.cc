#include "coordinator/scenario/load.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <variant>

#include "coordinator/scenario/load_prices.h"
#include "tests/unit/scenario/scenario_folder.h"
#include "tests/unit/times.h"

namespace tcs {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Pair;

class LoadTest : public testing::Test {
 protected:
  Scenario Load(std::string_view text, const ScenarioOverrides& overrides = {}) {
    return ScenarioOf(LoadScenario(folder_.Write("s.yaml", text), overrides));
  }

  ScenarioFolder folder_;
};

TEST_F(LoadTest, TheRunIsAsWritten) {
  const Scenario scenario = Load(kGoodScenario);
  EXPECT_EQ(scenario.name, "pursuit");
  EXPECT_EQ(scenario.path, folder_.Path("s.yaml"));
  EXPECT_EQ(scenario.duration, VirtualDuration::Seconds(20));
  EXPECT_EQ(scenario.drift_bound, Ms(2));
  EXPECT_EQ(scenario.seed, 7u);
  EXPECT_EQ(scenario.csv_period, Ms(20));
}

TEST_F(LoadTest, TheWorldIsAsWritten) {
  const Scenario scenario = Load(kGoodScenario);
  ASSERT_TRUE(scenario.world);
  EXPECT_EQ(scenario.world->integrator.kind, IntegratorKind::kVerlet);
  EXPECT_EQ(scenario.world->integrator.accuracy, 1e-4);
  EXPECT_EQ(scenario.world->integrator.fixed_step, VirtualDuration{});
  EXPECT_THAT(scenario.world->gravity_mps2, ElementsAre(0, 0, -9.81));
  EXPECT_TRUE(scenario.world->has_region);
  EXPECT_EQ(scenario.world->region.half_extent_m, 12);
  EXPECT_EQ(scenario.world->region.stiffness_npm, 40);
  EXPECT_EQ(scenario.world->region.damping_nspm, 0.5);

  ASSERT_EQ(scenario.world->bodies.size(), 2u);
  const BodySpec& predator = scenario.world->bodies[0];
  EXPECT_EQ(predator.name, "predator");
  EXPECT_EQ(predator.mass_kg, 1.5);
  EXPECT_THAT(predator.inertia_kgm2, ElementsAre(0.1, 0.2, 0.3));
  EXPECT_THAT(predator.initial.position_m, ElementsAre(-5, 0, 0));
  EXPECT_THAT(predator.initial.orientation_xyzw, ElementsAre(0, 0, 0, 1));
  EXPECT_EQ(scenario.world->bodies[1].name, "prey");
  EXPECT_THAT(scenario.world->bodies[1].initial.linear_velocity_mps, ElementsAre(1, 2, 3));
}

TEST_F(LoadTest, PricesAreTheHostsUnlessGiven) {
  const auto robot = [this](const std::string& cpu) {
    return Load(WithReplaced("cpu: {cores: 4, speed: 0.5}", cpu)).robots[0];
  };
  EXPECT_EQ(robot("cpu: {}").prices.Hash(), ShippedPrices().Hash());
  EXPECT_TRUE(robot("cpu: {}").prices_are_hosts);
  EXPECT_EQ(robot("cpu: {costs: none}").prices.Hash(), NoPrices().Hash());
  const std::string part =
      "{send: [1us, 2us, 3us, 4us], send_further: [5us, 6us, 7us, 8us], receive: [0, 0, 9us, 1ms]}";
  const std::string path =
      folder_.Write("prices.yaml", "machine: a pi\ndds:\n  reliable: " + part +
                                       "\n  best_effort: " + part + "\n  computed: " + part + "\n");
  const RobotSpec given = robot("cpu: {costs: " + path + "}");
  EXPECT_FALSE(given.prices_are_hosts);
  EXPECT_EQ(given.prices.name, path + " (a pi)");
  EXPECT_EQ(given.prices.dds_reliable.send.Of(65536), VirtualDuration::Microseconds(3));
  EXPECT_EQ(given.prices.dds_best_effort.send_further.Of(0), VirtualDuration::Microseconds(5));
  EXPECT_EQ(given.prices.dds_computed.receive.Of(1 << 20), VirtualDuration::Milliseconds(1));
}

TEST_F(LoadTest, AListOfPricesIsReadWithItsPlace) {
  const auto complaint = [this](const std::string& text) {
    const auto list = LoadPriceFile(folder_.Write("prices.yaml", text));
    const auto* error = std::get_if<LoadError>(&list);
    return error == nullptr ? "" : error->message;
  };
  EXPECT_THAT(complaint("dds: {}"),
              HasSubstr("prices.yaml:1: dds lacks the key 'reliable'; add it"));
  EXPECT_THAT(complaint("dds:\n  reliable:\n    send: [1us, 2us]\n"),
              HasSubstr("prices.yaml:3: dds.reliable.send has to be four durations"));
  EXPECT_THAT(complaint("ddss: {}"), HasSubstr("unknown key 'ddss'"));
}

TEST_F(LoadTest, WakingAThreadTakesNoTimeUnlessGiven) {
  const auto wakeup = [this](const std::string& cpu) {
    return Load(WithReplaced("cpu: {cores: 4, speed: 0.5}", cpu)).robots[0].wakeup;
  };
  EXPECT_EQ(wakeup("cpu: {}").median, VirtualDuration());
  EXPECT_EQ(wakeup("cpu: {wakeup: 0}").median, VirtualDuration());
  const WakeupSpec always = wakeup("cpu: {wakeup: 50us}");
  EXPECT_EQ(always.median, VirtualDuration::Microseconds(50));
  EXPECT_EQ(always.p99, always.median);
  const WakeupSpec spread = wakeup("cpu: {wakeup: {median: 20us, p99: 80us}}");
  EXPECT_EQ(spread.median, VirtualDuration::Microseconds(20));
  EXPECT_EQ(spread.p99, VirtualDuration::Microseconds(80));
}

TEST_F(LoadTest, TheRobotsAreAsWritten) {
  const Scenario scenario = Load(kGoodScenario);
  ASSERT_EQ(scenario.robots.size(), 1u);
  const RobotSpec& robot = scenario.robots[0];
  EXPECT_EQ(robot.name, "hunter");
  EXPECT_EQ(robot.cores, 4);
  EXPECT_EQ(robot.speed, 0.5);
  ASSERT_EQ(robot.clients.size(), 2u);
  const ClientSpec& controller = robot.clients[0];
  EXPECT_EQ(controller.name, "hunter/controller");
  EXPECT_THAT(controller.command, ElementsAre(folder_.Path("controller"), "--seed", "7"));
  EXPECT_EQ(controller.working_directory, folder_.path());
  EXPECT_EQ(controller.client_class, ClientClass::kPeriodic);
  EXPECT_EQ(controller.priority, 80);
  EXPECT_EQ(controller.body, 0);
  EXPECT_THAT(controller.environment, ElementsAre(Pair("MODE", "fast")));
  EXPECT_EQ(controller.fixed_call_cost, VirtualDuration::Microseconds(3));
  EXPECT_EQ(controller.fixed_allocation_cost, std::nullopt);
  const ClientSpec& planner = robot.clients[1];
  EXPECT_EQ(planner.name, "hunter/planner");
  EXPECT_EQ(planner.client_class, ClientClass::kBestEffort);
  EXPECT_EQ(planner.priority, 0);
  EXPECT_EQ(planner.body, std::nullopt);
  EXPECT_EQ(planner.fixed_call_cost, VirtualDuration::Microseconds(1));
  EXPECT_EQ(planner.fixed_allocation_cost, VirtualDuration::Nanoseconds(50));
  EXPECT_FALSE(planner.patch_vdso);
  EXPECT_TRUE(controller.patch_vdso);
  EXPECT_EQ(planner.cycle_counter, CycleCounter::kHost);
  EXPECT_EQ(controller.cycle_counter, CycleCounter::kVirtual);
}

TEST_F(LoadTest, ARobotMayBeIdeal) {
  EXPECT_TRUE(Load(WithReplaced("cpu: {cores: 4, speed: 0.5}", "cpu: ideal")).robots[0].is_ideal);
  EXPECT_FALSE(Load(kGoodScenario).robots[0].is_ideal);
}

TEST_F(LoadTest, TheChannelsAreAsWritten) {
  const Scenario scenario = Load(kGoodScenario);
  ASSERT_EQ(scenario.sensors.size(), 1u);
  const SensorChannelSpec& eyes = scenario.sensors[0];
  EXPECT_EQ(eyes.name, "eyes");
  EXPECT_THAT(eyes.bodies, ElementsAre(0, 1));
  EXPECT_EQ(eyes.period, Ms(20));
  EXPECT_EQ(eyes.latency, Ms(2));
  EXPECT_EQ(std::get<UdpEndpoint>(eyes.to).host, "127.0.0.1");
  EXPECT_EQ(std::get<UdpEndpoint>(eyes.to).port, 47010);
  ASSERT_EQ(scenario.commands.size(), 1u);
  const CommandChannelSpec& hands = scenario.commands[0];
  EXPECT_EQ(hands.name, "hands");
  EXPECT_EQ(hands.body, 1);
  EXPECT_EQ(hands.latency, Ms(3));
  EXPECT_EQ(std::get<UdpEndpoint>(hands.from).port, 47011);
}

TEST_F(LoadTest, ContactsAreWrittenIfAskedFor) {
  const std::string world =
      "dynamics: {}\nmodels: {floor: {plane: [0, 0, 1]}, box: {box: [1, 1, 1], mass: 1}}\n";
  const std::string rest = "duration: 1\nrobots: {r: {clients: {c: {command: [sh]}}}}\n";
  const Scenario scenario = Load(rest + world + "csv_contacts: true\n");
  EXPECT_TRUE(scenario.csv_contacts);
  EXPECT_THAT(scenario.warnings, IsEmpty());
  EXPECT_FALSE(Load(rest + world).csv_contacts);
  EXPECT_FALSE(Load(rest + world + "csv_contacts: false\n").csv_contacts);
  // Where nothing can touch it is hardly what was meant, on ODE, too.
  const std::string body = "bodies: {b: {mass: 1, inertia: [1, 1, 1]}}\ncsv_contacts: true\n";
  for (const char* dynamics : {"dynamics: {}\n", "dynamics: {engine: ode}\n"}) {
    EXPECT_THAT(Load(rest + dynamics + body).warnings,
                ElementsAre(HasSubstr("s.yaml:5: csv_contacts finds none to write")));
  }
  EXPECT_THAT(Load(rest + "csv_contacts: true\n").warnings,
              ElementsAre(HasSubstr("s.yaml:3: csv_contacts finds none to write")));
  EXPECT_THAT(Load(rest + "csv_contacts: false\n").warnings, IsEmpty());
}

TEST_F(LoadTest, WhatIsLeftOutHasDefaults) {
  const Scenario scenario = Load("duration: 1\nrobots: {r: {clients: {c: {command: [sh]}}}}\n");
  EXPECT_EQ(scenario.name, "s");
  EXPECT_EQ(scenario.drift_bound, Ms(1));
  EXPECT_EQ(scenario.seed, 1u);
  EXPECT_EQ(scenario.csv_period, Ms(10));
  EXPECT_FALSE(scenario.world);
  EXPECT_EQ(scenario.robots[0].cores, 1);
  EXPECT_EQ(scenario.robots[0].speed, 1.0);
  EXPECT_TRUE(scenario.sensors.empty());
}

TEST_F(LoadTest, DynamicsMayBeAllDefaults) {
  const Scenario scenario = Load(
      "duration: 1\ndynamics: {}\nbodies: {b: {mass: 1, inertia: [1, 1, 1]}}\n"
      "robots: {r: {clients: {c: {command: [sh]}}}}\n");
  ASSERT_TRUE(scenario.world);
  EXPECT_EQ(scenario.world->integrator.kind, IntegratorKind::kRungeKutta3);
  EXPECT_EQ(scenario.world->integrator.accuracy, 1e-5);
  EXPECT_FALSE(scenario.world->has_region);
}

TEST_F(LoadTest, AStepMakesTheIntegratorsStepsFixed) {
  const Scenario scenario = Load(WithReplaced("accuracy: 1e-4", "step: 0.5ms"));
  EXPECT_EQ(scenario.world->integrator.fixed_step, VirtualDuration::Microseconds(500));
}

TEST_F(LoadTest, TheEngineCanBeOdeWithAStepOfItsOwnOrOfOurs) {
  EXPECT_EQ(Load(kGoodScenario).world->integrator.engine, EngineKind::kSimbody);
  const auto integrator = [this](std::string_view lines) {
    return Load(WithReplaced("  integrator: verlet\n  accuracy: 1e-4\n", lines)).world->integrator;
  };
  EXPECT_EQ(integrator("  engine: simbody\n").engine, EngineKind::kSimbody);
  EXPECT_EQ(integrator("  engine: ode\n").engine, EngineKind::kOde);
  EXPECT_EQ(integrator("  engine: ode\n").fixed_step, VirtualDuration{});
  EXPECT_EQ(integrator("  engine: ode\n  step: 2ms\n").fixed_step,
            VirtualDuration::Milliseconds(2));
}

TEST_F(LoadTest, TheAirIsAsWritten) {
  const std::string with_drag = WithReplaced(
      "mass: 2,", "mass: 2, drag: {linear: 0.3, quadratic: 0.1, angular_linear: 0.02},");
  const auto world_with = [&](std::string_view wind) {
    return *Load(WithReplaced("gravity: [0, 0, -9.81]", wind, with_drag)).world;
  };
  const WorldSpec steady = world_with("wind: [3, 0, -1]");
  EXPECT_THAT(steady.wind.mean_mps, ElementsAre(3, 0, -1));
  EXPECT_EQ(steady.wind.gusts_mps, 0);
  EXPECT_EQ(steady.bodies[0].drag, DragSpec{});
  EXPECT_EQ(
      steady.bodies[1].drag,
      (DragSpec{.linear_nspm = 0.3, .quadratic_ns2pm2 = 0.1, .angular_linear_nmsprad = 0.02}));
  const WindSpec wind = world_with("wind: {mean: [3, 0, 0], gusts: 1.5, gust_time: 2s}").wind;
  EXPECT_THAT(wind.mean_mps, ElementsAre(3, 0, 0));
  EXPECT_EQ(wind.gusts_mps, 1.5);
  EXPECT_EQ(wind.gust_time, VirtualDuration::Seconds(2));
  const std::string blowing = WithReplaced("gravity: [0, 0, -9.81]", "wind: {gusts: 1}", with_drag);
  EXPECT_EQ(Load(blowing).world->wind.seed, Load(blowing).world->wind.seed);
  EXPECT_NE(Load(blowing).world->wind.seed, Load(blowing, {.seed = 8}).world->wind.seed);
  EXPECT_TRUE(Load(blowing).warnings.empty());
  EXPECT_THAT(
      Load(WithReplaced("gravity: [0, 0, -9.81]", "wind: [1, 0, 0]")).warnings,
      ElementsAre(folder_.Path("s.yaml") + ":9: dynamics.wind moves no body because no body has "
                                           "drag; give one a drag, like drag: {linear: 0.3}"));
}

TEST_F(LoadTest, BodiesThatStandTogetherAreOneIsland) {
  EXPECT_TRUE(Load(kGoodScenario).world->together.empty());
  EXPECT_THAT(
      Load(WithReplaced("gravity: [0, 0, -9.81]", "together: [[prey, predator]]")).world->together,
      ElementsAre(ElementsAre(1, 0)));
}

TEST_F(LoadTest, HowCommandsActIsAsWritten) {
  const CommandChannelSpec plain = Load(kGoodScenario).commands[0];
  EXPECT_FALSE(plain.in_body_frame);
  EXPECT_EQ(plain.lag, VirtualDuration{});
  const CommandChannelSpec motors =
      Load(WithReplaced("latency: 3ms", "axes: body, lag: 50ms")).commands[0];
  EXPECT_TRUE(motors.in_body_frame);
  EXPECT_EQ(motors.lag, Ms(50));
  EXPECT_FALSE(Load(WithReplaced("latency: 3ms", "axes: world")).commands[0].in_body_frame);
}

TEST_F(LoadTest, OrientationsAreNormalised) {
  const Scenario scenario =
      Load(WithReplaced("position: [-5, 0, 0]", "orientation: [0, 0, 0.7071, 0.7071]"));
  EXPECT_THAT(scenario.world->bodies[0].initial.orientation_xyzw,
              ElementsAre(0, 0, testing::DoubleNear(0.70710678118, 1e-10),
                          testing::DoubleNear(0.70710678118, 1e-10)));
}

TEST_F(LoadTest, TheOrderOfTheFileIsKept) {
  const Scenario scenario = Load(
      "duration: 1\nrobots:\n"
      "  zeta: {clients: {z: {command: [sh]}, a: {command: [sh]}, m: {command: [sh]}}}\n"
      "  alpha: {clients: {c: {command: [sh]}}}\n");
  EXPECT_EQ(scenario.robots[0].name, "zeta");
  EXPECT_EQ(scenario.robots[1].name, "alpha");
  EXPECT_EQ(scenario.robots[0].clients[0].name, "zeta/z");
  EXPECT_EQ(scenario.robots[0].clients[1].name, "zeta/a");
  EXPECT_EQ(scenario.robots[0].clients[2].name, "zeta/m");
}

TEST_F(LoadTest, RatesThatDivideNoSecondAreRoundedToTheNanosecond) {
  EXPECT_EQ(Load(WithReplaced("rate: 50", "rate: 30")).sensors[0].period,
            VirtualDuration::Nanoseconds(33'333'333));
  EXPECT_EQ(Load(WithReplaced("rate: 50", "rate: 0.6")).sensors[0].period,
            VirtualDuration::Nanoseconds(1'666'666'667));
}

TEST_F(LoadTest, TheCommandLineOverridesTheFile) {
  const Scenario scenario =
      Load(kGoodScenario, {.duration = Ms(5), .drift = Ms(3), .seed = 18446744073709551615u});
  EXPECT_EQ(scenario.duration, Ms(5));
  EXPECT_EQ(scenario.drift_bound, Ms(3));
  EXPECT_EQ(scenario.seed, 18446744073709551615u);
  EXPECT_EQ(scenario.robots[0].clients[0].command[2], "18446744073709551615");
}

TEST_F(LoadTest, VariablesAreReplacedInArgumentsAndEnvironment) {
  setenv("TCS_TEST_WORD", "a b", 1);
  std::string text = WithReplaced("\"${seed}\"", "\"<${TCS_TEST_WORD}|${seed}|$${seed}|$$|$1>\"");
  text.replace(text.find("MODE: fast"), 10, "MODE: \"x${TCS_TEST_WORD}\", EMPTY: \"\"");
  const ClientSpec client = Load(text).robots[0].clients[0];
  EXPECT_EQ(client.command[2], "<a b|7|${seed}|$$|$1>");
  EXPECT_THAT(client.environment, ElementsAre(Pair("EMPTY", ""), Pair("MODE", "xa b")));
}

TEST_F(LoadTest, ClassesMayBeWrittenWithAnUnderscore) {
  const Scenario scenario = Load(WithReplaced("class: periodic", "class: best_effort"));
  EXPECT_EQ(scenario.robots[0].clients[0].client_class, ClientClass::kBestEffort);
}

TEST_F(LoadTest, DeadlinesGoWithTheEarliestDeadlineFirst) {
  const std::string text = WithReplaced("priority: 80", "deadline: 4ms");
  const Scenario scenario =
      Load(WithReplaced("    cpu: {cores", "    scheduler: edf\n    cpu: {cores", text));
  const RobotSpec& robot = scenario.robots[0];
  EXPECT_EQ(robot.scheduler, SchedulerPolicy::kEarliestDeadlineFirst);
  EXPECT_EQ(robot.clients[0].deadline, VirtualDuration::Milliseconds(4));
  EXPECT_EQ(robot.clients[1].deadline, VirtualDuration{});
}

TEST_F(LoadTest, CommandsAreRelativeToTheFileWhereverTcsimRuns) {
  const auto before = std::filesystem::current_path();
  folder_.Write("s.yaml", kGoodScenario);
  std::filesystem::current_path(folder_.path());
  const auto result = LoadScenario("s.yaml");
  std::filesystem::current_path(before);
  ASSERT_TRUE(std::holds_alternative<Scenario>(result)) << std::get<LoadError>(result).message;
  EXPECT_EQ(std::get<Scenario>(result).robots[0].clients[0].command[0], folder_.Path("controller"));
}

}  // namespace
}  // namespace tcs
