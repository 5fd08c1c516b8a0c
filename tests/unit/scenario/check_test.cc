// `tcsim check` says all that is wrong with a scenario, and nothing that is wrong only because
// something else is.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "coordinator/scenario/load.h"
#include "tests/unit/scenario/scenario_folder.h"

namespace tcs {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::vector<std::string> MistakesIn(const ScenarioFolder& folder, std::string_view text) {
  const auto checked = CheckScenario(folder.Write("s.yaml", text));
  std::vector<std::string> sentences;
  if (const auto* mistakes = std::get_if<std::vector<LoadError>>(&checked)) {
    for (const LoadError& mistake : *mistakes) {
      sentences.push_back(mistake.message.substr(folder.path().size() + 1));
    }
  }
  return sentences;
}

TEST(Check, FindsNothingInAGoodScenario) {
  const ScenarioFolder folder;
  EXPECT_THAT(MistakesIn(folder, kGoodScenario), ElementsAre());
}

TEST(Check, SaysAllMistakesInTheOrderOfTheLines) {
  const ScenarioFolder folder;
  EXPECT_THAT(MistakesIn(folder, R"(duration: -3s
sed: 3
dynamics: {engine: simbodi}
bodies:
  drone: {mass: heavy, inertia: [1, 1, 1], positon: [0, 0, 0]}
  rock: {mass: 1}
robots:
  r:
    cpu: {cores: 0, speed: fast}
    clients:
      a: {command: [./controller], priority: 100, body: drone}
      b: {command: [./missing]}
channels:
  eyes: {type: udp_json, sensors: {bodies: [drone], rate: 50, to: "127.0.0.1:0"}}
  hands: {type: tcp, commands: {body: drone, listen: "127.0.0.1:47011"}}
)"),
              ElementsAre(HasSubstr("s.yaml:1: duration: '-3s' is not a duration"),
                          HasSubstr("s.yaml:2: unknown key 'sed'; did you mean 'seed'?"),
                          HasSubstr("s.yaml:3: dynamics.engine is the unknown 'simbodi'"),
                          HasSubstr("s.yaml:5: unknown key 'positon' in bodies.drone"),
                          HasSubstr("s.yaml:5: bodies.drone.mass is 'heavy'"),
                          HasSubstr("s.yaml:6: bodies.rock lacks the key 'inertia'"),
                          HasSubstr("s.yaml:9: robots.r.cpu.cores is '0'"),
                          HasSubstr("s.yaml:9: robots.r.cpu.speed is 'fast'"),
                          HasSubstr("s.yaml:11: robots.r.clients.a.priority is '100'"),
                          HasSubstr("s.yaml:12: robots.r.clients.b.command"),
                          HasSubstr("s.yaml:14: channels.eyes.sensors.to"),
                          HasSubstr("s.yaml:15: channels.hands.type is the unknown 'tcp'")));
}

TEST(Check, ASerialPortMayBeOfARobotThatHasMistakes) {
  const ScenarioFolder folder;
  EXPECT_THAT(MistakesIn(folder, R"(duration: 1s
dynamics: {}
bodies:
  drone: {mass: 1, inertia: [1, 1, 1]}
robots:
  r: {clients: 3}
channels:
  one: {type: pty, sensors: {bodies: [drone], rate: 50, robot: r, device: /dev/ttyS0}}
)"),
              ElementsAre(HasSubstr("s.yaml:6: robots.r.clients")));
}

TEST(Check, DoesNotBlameWhatNamesSomethingThatIsWrong) {
  const ScenarioFolder folder;
  EXPECT_THAT(MistakesIn(folder, R"(duration: 1s
dynamics: {together: [[drone, rock]]}
bodies:
  drone: {mass: 1}
  rock: {mass: 1, inertia: [1, 1, 1]}
robots:
  r: {clients: {a: {command: [./controller], body: drone}}}
channels:
  eyes: {type: udp_json, sensors: {bodies: [drone, rock], rate: 50, to: "127.0.0.1:47010"}}
)"),
              ElementsAre(HasSubstr("s.yaml:4: bodies.drone lacks the key 'inertia'")));
}

TEST(Check, SaysWhereTheCommandLineIsWrong) {
  const ScenarioFolder folder;
  const auto checked = CheckScenario(folder.Write("s.yaml", kGoodScenario),
                                     {.set = {"drft=1ms", "robots.hunter.cpu.cores=65"}});
  const auto& mistakes = std::get<std::vector<LoadError>>(checked);
  ASSERT_EQ(mistakes.size(), 2u);
  EXPECT_THAT(mistakes[0].message, HasSubstr("--set drft=1ms: unknown key 'drft'"));
  EXPECT_THAT(mistakes[1].message, HasSubstr("--set robots.hunter.cpu.cores=65: "));
}

TEST(Check, SaysOnceThatThereAreNoRobots) {
  const ScenarioFolder folder;
  const auto lacks = HasSubstr("s.yaml:1: the scenario lacks the key 'robots'");
  EXPECT_THAT(MistakesIn(folder, "duration: 1s\n"), ElementsAre(lacks));
  EXPECT_THAT(MistakesIn(folder, "duration: 1s\nnetwork: {}\n"), ElementsAre(lacks));
}

}  // namespace
}  // namespace tcs
