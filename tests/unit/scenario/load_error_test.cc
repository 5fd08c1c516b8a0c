// Every mistake in a scenario file is one sentence that begins with its place.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <ostream>
#include <variant>

#include "coordinator/scenario/load.h"
#include "tests/unit/scenario/scenario_folder.h"

namespace tcs {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

struct Mistake {
  std::string_view name;
  std::string_view from;  // in kGoodScenario
  std::string_view to;
  int line;
  std::vector<std::string_view> words;
};

void PrintTo(const Mistake& mistake, std::ostream* out) { *out << mistake.name; }

class MistakeTest : public testing::TestWithParam<Mistake> {};

TEST_P(MistakeTest, IsOneSentenceWithItsPlace) {
  const ScenarioFolder folder;
  const Mistake& mistake = GetParam();
  const std::string complaint = Complaint(folder, WithReplaced(mistake.from, mistake.to));
  EXPECT_THAT(complaint, StartsWith("s.yaml:" + std::to_string(mistake.line) + ": "));
  for (const std::string_view words : mistake.words) {
    EXPECT_THAT(complaint, HasSubstr(std::string(words)));
  }
  EXPECT_EQ(complaint.find('\n'), std::string::npos);
}

const Mistake kRunMistakes[] = {
    {"UnknownKey", "csv_period:", "csv_perod:", 5, {"unknown key 'csv_perod'", "'csv_period'?"}},
    {"UnknownKeyOfNoKind", "seed: 7", "colour: red", 4, {"'colour'", "the keys here are name"}},
    {"UnknownNestedKey",
     "    mass: 1.5",
     "    mas: 1.5",
     13,
     {"unknown key 'mas' in bodies.predator", "did you mean 'mass'?"}},
    {"MissingDuration", "duration: 20s\n", "", 1, {"the scenario lacks the key 'duration'", "20s"}},
    {"BadUnit", "20s", "20 sec", 2, {"duration: '20 sec'", "unknown unit 'sec'", "ms"}},
    {"ZeroDuration", "20s", "0s", 2, {"duration is 0s", "longer than 0"}},
    {"NegativeDuration", "20s", "-1s", 2, {"must not be negative"}},
    {"EmptyDuration", "20s", "", 2, {"duration has no value"}},
    {"DurationIsAList", "20s", "[20]", 2, {"duration is a list"}},
    {"ZeroDrift", "2ms\nseed", "0\nseed", 3, {"drift is 0"}},
    {"NegativeSeed", "seed: 7", "seed: -7", 4, {"seed is '-7'", "whole number"}},
    {"DuplicateKey", "seed: 7", "duration: 1s", 4, {"duration is given twice", "line 2"}},
    {"EmptyName", "name: pursuit", "name: \"\"", 1, {"name is empty"}},
    {"MissingRobots", "robots:\n", "bots:\n", 17, {"unknown key 'bots'", "'robots'?"}},
    {"NulInText", "name: pursuit", "name: \"a\\0b\"", 1, {"NUL"}},
};

const Mistake kWorldMistakes[] = {
    {"NegativeMass", "mass: 1.5", "mass: -1", 13, {"bodies.predator.mass is -1", "positive"}},
    {"ZeroMass", "mass: 2,", "mass: 0,", 16, {"bodies.prey.mass is 0", "positive", "kilograms"}},
    {"MassOnALaterLine", "mass: 1.5", "mass:\n      -1", 14, {"mass is -1"}},
    {"MassIsNoNumber", "mass: 1.5", "mass: heavy", 13, {"'heavy'", "number"}},
    {"MassIsNotFinite", "mass: 1.5", "mass: nan", 13, {"finite number"}},
    {"MissingMass", "    mass: 1.5\n", "", 12, {"bodies.predator lacks the key 'mass'"}},
    {"MissingInertia", ", inertia: [1, 1, 1]", "", 16, {"bodies.prey lacks the key 'inertia'"}},
    {"ImpossibleInertia", "[0.1, 0.2, 0.3]", "[0.1, 0.2, 0.4]", 14, {"impossible", "sum"}},
    {"NegativeInertia", "[0.1, 0.2, 0.3]", "[0.1, -0.2, 0.3]", 14, {"impossible", "positive"}},
    {"ShortVector", "[-5, 0, 0]", "[-5, 0]", 15, {"position has 2 numbers", "[0, 0, 0]"}},
    {"VectorIsANumber", "[-5, 0, 0]", "5", 15, {"position is not a list"}},
    {"WordInVector", "[-5, 0, 0]", "[-5, x, 0]", 15, {"bodies.predator.position[1] is 'x'"}},
    {"WordInBlockVector", "[-5, 0, 0]", "\n    - -5\n    - x\n    - 0", 17, {"position[1]"}},
    {"NoUnitQuaternion",
     "position: [-5, 0, 0]",
     "orientation: [0, 0, 1, 1]",
     15,
     {"not a unit quaternion", "1.41"}},
    {"DuplicateBody", "  prey: {", "  predator: {", 16, {"bodies.predator", "twice", "line 12"}},
    {"BadBodyName", "  prey: {", "  \"../prey\": {", 16, {"'../prey' is not a name"}},
    {"BodyIsEmpty",
     "{mass: 2, inertia: [1, 1, 1], linear_velocity: [1, 2, 3]}",
     "",
     16,
     {"bodies.prey has no value"}},
    {"UnknownIntegrator", "verlet", "velvet", 7, {"unknown 'velvet'", "did you mean 'verlet'?"}},
    {"UnknownEngine",
     "dynamics:\n",
     "dynamics:\n  engine: odd\n",
     7,
     {"dynamics.engine is the unknown 'odd'", "did you mean 'ode'?"}},
    {"IntegratorOfOde",
     "dynamics:\n  integrator: verlet\n  accuracy: 1e-4\n",
     "dynamics:\n  integrator: verlet\n  engine: ode\n",
     7,
     {"dynamics.integrator is Simbody's, and dynamics.engine is ode", "remove it"}},
    {"AccuracyOfOde",
     "dynamics:\n  integrator: verlet\n",
     "dynamics:\n  engine: ode\n",
     8,
     {"dynamics.accuracy is Simbody's", "remove it"}},
    {"AccuracyAndStep", "accuracy: 1e-4", "accuracy: 1e-4\n  step: 1ms", 9, {"step", "accuracy"}},
    {"ZeroAccuracy", "1e-4", "0", 8, {"dynamics.accuracy is 0", "positive"}},
    {"AccuracyOfOne", "1e-4", "1", 8, {"below 1"}},
    {"ZeroStep", "accuracy: 1e-4", "step: 0", 8, {"dynamics.step is 0"}},
    {"ZeroRegion", "half_extent: 12", "half_extent: 0", 10, {"half_extent is 0", "metres"}},
    {"NegativeStiffness", "stiffness: 40", "stiffness: -40", 10, {"must not be negative"}},
    {"MisspeltWind", "gravity: [", "wnid: [", 9, {"unknown key 'wnid'", "did you mean 'wind'?"}},
    {"ShortWind", "gravity: [0, 0, -9.81]", "wind: [1]", 9, {"dynamics.wind has 1 number"}},
    {"MisspeltGusts",
     "gravity: [0, 0, -9.81]",
     "wind: {gust: 1}",
     9,
     {"unknown key 'gust' in dynamics.wind", "'gusts'?"}},
    {"NegativeGusts", "gravity: [0, 0, -9.81]", "wind: {gusts: -1}", 9, {"not be negative"}},
    {"TimeOfNoGusts",
     "gravity: [0, 0, -9.81]",
     "wind: {gust_time: 1s}",
     9,
     {"wind.gust_time needs gusts, but there are none"}},
    {"MisspeltDrag",
     "mass: 2,",
     "mass: 2, drag: {liner: 1},",
     16,
     {"unknown key 'liner' in bodies.prey.drag", "'linear'?"}},
    {"NegativeDrag",
     "mass: 2,",
     "mass: 2, drag: {quadratic: -1},",
     16,
     {"bodies.prey.drag.quadratic is -1", "negative"}},
    {"TogetherWithAStranger",
     "gravity: [0, 0, -9.81]",
     "together: [[prey, preditor]]",
     9,
     {"dynamics.together[0][1] names the unknown body 'preditor'", "'predator'?"}},
    {"TogetherTwice",
     "gravity: [0, 0, -9.81]",
     "together: [[prey, predator, prey]]",
     9,
     {"together[0][2] names the body 'prey' a second time", "one list"}},
    {"TogetherAlone",
     "gravity: [0, 0, -9.81]",
     "together: [[prey]]",
     9,
     {"dynamics.together[0] names one body", "two or more"}},
    {"BodiesWithoutDynamics",
     "dynamics:\n  integrator: verlet\n  accuracy: 1e-4\n  gravity: [0, 0, -9.81]\n"
     "  region: {half_extent: 12, stiffness: 40, damping: 0.5}\n",
     "",
     6,
     {"bodies need physics", "dynamics: {}"}},
};

const Mistake kRobotMistakes[] = {
    {"ZeroCores", "cores: 4", "cores: 0", 19, {"robots.hunter.cpu.cores is '0'", "from 1 to 64"}},
    {"TooManyCores", "cores: 4", "cores: 65", 19, {"cores is '65'", "from 1 to 64"}},
    {"HalfACore", "cores: 4", "cores: 0.5", 19, {"whole number"}},
    {"ZeroSpeed", "speed: 0.5", "speed: 0", 19, {"speed is 0", "positive"}},
    {"NegativeSpeed", "speed: 0.5", "speed: -1", 19, {"speed is -1", "positive"}},
    {"AbsurdSpeed", "speed: 0.5", "speed: 1e9", 19, {"speed is 1e9", "between"}},
    {"WakeupWithoutSpread", "speed: 0.5", "wakeup: {median: 1ms}", 19, {"p99", "80us"}},
    {"WakeupOfWhat", "speed: 0.5", "wakeup: soon", 19, {"wakeup", "soon"}},
    {"WakeupsAsLongAsRuns", "speed: 0.5", "wakeup: 2s", 19, {"wakeup is 2s", "at most 1 s"}},
    {"WakeupBelowItsMedian",
     "speed: 0.5",
     "wakeup: {median: 2ms, p99: 1ms}",
     19,
     {"wakeup has a p99 that is below its median"}},
    {"NoPriceList",
     "speed: 0.5",
     "costs: gone.yaml",
     19,
     {"costs", "gone.yaml: cannot be read", "or write none"}},
    {"NamelessPriceList", "speed: 0.5", "costs: ''", 19, {"costs is empty"}},
    {"UnknownScheduler",
     "    clients:\n      controller",
     "    scheduler: edv\n    clients:\n      controller",
     20,
     {"robots.hunter.scheduler is the unknown 'edv'", "'edf'?"}},
    {"PeriodicWithoutDeadline",
     "    clients:\n      controller",
     "    scheduler: edf\n    clients:\n      controller",
     22,
     {"controller has no deadline", "deadline: 10ms"}},
    {"UnknownClass", "class: periodic", "class: perodic", 23, {"'perodic'", "'periodic'?"}},
    {"PriorityTooHigh", "priority: 80", "priority: 100", 24, {"'100'", "from 0 to 99"}},
    {"UnknownBody",
     "body: predator\n",
     "body: preditor\n",
     25,
     {"robots.hunter.clients.controller.body", "unknown body 'preditor'", "'predator'?"}},
    {"FreeCalls", "fixed_call_cost: 3us", "fixed_call_cost: 0", 27, {"longer than 0"}},
    {"PatchOfWhat", "patch_vdso: false", "patch_vdso: yes", 28, {"'yes'", "true or false"}},
    {"CounterOfWhat", "rdtsc: host", "rdtsc: hots", 28, {"unknown 'hots'", "'host'?"}},
    {"EqualsInVariable", "{MODE: fast}", "{\"A=B\": fast}", 26, {"environment variable's name"}},
    {"VariableWithoutValue", "{MODE: fast}", "{MODE: }", 26, {"MODE has no value", "quotes"}},
    {"DuplicateClient", "      planner:", "      controller:", 28, {"twice", "line 21"}},
    {"CpuIsAnotherWord",
     "cpu: {cores: 4, speed: 0.5}",
     "cpu: idael",
     19,
     {"robots.hunter.cpu is 'idael'", "write ideal, or a map"}},
    {"MisspeltClients", "    clients:", "    client:", 20, {"unknown key 'client'", "'clients'?"}},
    {"ClientIsAText",
     "{command: [sh, -c, \"true\"], patch_vdso: false, rdtsc: host, fixed_allocation_cost: 50ns}",
     "sh",
     28,
     {"planner is not a map"}},
};

const Mistake kChannelMistakes[] = {
    {"UnknownType",
     "  eyes:\n    type: udp_json",
     "  eyes:\n    type: upd_json",
     31,
     {"channels.eyes.type", "unknown 'upd_json'", "'udp_json'?"}},
    {"MissingType", "  eyes:\n    type: udp_json\n", "  eyes:\n", 30, {"lacks the key 'type'"}},
    {"DuplicatePort",
     ":47011",
     ":47010",
     35,
     {"port 47010 again", "channels.eyes.sensors.to on line 32"}},
    {"DuplicatePortOfAllAddresses", "127.0.0.1:47011", "0.0.0.0:47010", 35, {"47010 again"}},
    {"DuplicateChannel", "  hands:", "  eyes:", 33, {"channels.eyes is given twice", "line 30"}},
    {"UnknownSensorBody",
     "[predator, prey]",
     "[predator, pray]",
     32,
     {"channels.eyes.sensors.bodies[1]", "unknown body 'pray'", "'prey'?"}},
    {"BodyTwice", "[predator, prey]", "[prey, prey]", 32, {"'prey' a second time"}},
    {"NoBodies", "[predator, prey]", "[]", 32, {"bodies is an empty list"}},
    {"UnknownCommandBody", "body: prey", "body: moon", 35, {"the bodies here are predator and"}},
    {"ZeroRate", "rate: 50", "rate: 0", 32, {"rate is 0", "positive (Hz)"}},
    {"AbsurdRate", "rate: 50", "rate: 1e9", 32, {"rate is 1e9", "1000000"}},
    {"NoPort", "127.0.0.1:47011", "127.0.0.1", 35, {"no port", "127.0.0.1:47010"}},
    {"PortZero", ":47011", ":0", 35, {"port '0'", "1 to 65535"}},
    {"PortTooHigh", ":47011", ":65536", 35, {"port '65536'"}},
    {"PortIsAWord", ":47011", ":http", 35, {"port 'http'"}},
    {"HostName", "127.0.0.1:47011", "localhost:47011", 35, {"'localhost'", "IPv4"}},
    {"ToAllAddresses", "127.0.0.1:47010", "0.0.0.0:47010", 32, {"nothing can be sent"}},
    {"NegativeLatency", "latency: 3ms", "latency: -3ms", 35, {"must not be negative"}},
    {"UnknownAxes", "latency: 3ms", "axes: boddy", 35, {"axes is the unknown 'boddy'", "'body'?"}},
    {"NegativeLag", "latency: 3ms", "lag: -3ms", 35, {"must not be negative"}},
    {"MisspeltLag", "latency: 3ms", "lags: 3ms", 35, {"unknown key 'lags'", "did you mean 'lag'?"}},
    {"CarriesNothing",
     "    commands: {body: prey, listen: \"127.0.0.1:47011\", latency: 3ms}\n",
     "",
     33,
     {"channels.hands carries nothing"}},
    {"CarriesBoth",
     "  hands:\n    type: udp_json\n    commands",
     "    commands",
     30,
     {"both sensors and commands"}},
};

std::string NameOf(const testing::TestParamInfo<Mistake>& info) {
  return std::string(info.param.name);
}
INSTANTIATE_TEST_SUITE_P(OfTheRun, MistakeTest, testing::ValuesIn(kRunMistakes), NameOf);
INSTANTIATE_TEST_SUITE_P(OfTheWorld, MistakeTest, testing::ValuesIn(kWorldMistakes), NameOf);
INSTANTIATE_TEST_SUITE_P(OfARobot, MistakeTest, testing::ValuesIn(kRobotMistakes), NameOf);
INSTANTIATE_TEST_SUITE_P(OfAChannel, MistakeTest, testing::ValuesIn(kChannelMistakes), NameOf);

struct WholeFile {
  std::string_view name;
  std::string_view text;
  std::string_view start;
};

void PrintTo(const WholeFile& file, std::ostream* out) { *out << file.name; }

class WholeFileTest : public testing::TestWithParam<WholeFile> {};

TEST_P(WholeFileTest, IsRefusedInOneSentence) {
  const ScenarioFolder folder;
  const std::string complaint = Complaint(folder, GetParam().text);
  EXPECT_THAT(complaint, StartsWith(std::string(GetParam().start)));
  EXPECT_EQ(complaint.find('\n'), std::string::npos);
}

#define TCS_WORLD "dynamics: {}\nbodies: {b: {mass: 1, inertia: [1, 1, 1]}}\n"
#define TCS_ROBOT "robots: {r: {clients: {c: {command: [sh]}}}}\n"

const WholeFile kWholeFiles[] = {
    {"Empty", "", "s.yaml:1: the scenario is empty"},
    {"OnlyAComment", "# nothing\n", "s.yaml:1: the scenario is empty"},
    {"AText", "hello\n", "s.yaml:1: the scenario is not a map"},
    {"AList", "- 1\n", "s.yaml:1: the scenario is not a map"},
    {"SyntaxError", "duration: 1s\nname: [a\nseed: 3\n", "s.yaml:3: this is not valid YAML"},
    {"TabIndentation", "duration: 1s\nrobots:\n\tr: 1\n", "s.yaml:3: this is not valid YAML"},
    {"UnquotedVariable", "duration: 1s\nrobots: {a: [b, ${seed}]}\n", "s.yaml:2: "},
    {"UnclosedList", "duration: 1s\nname: [a\n", "s.yaml:3: this is not valid YAML"},
    {"TwoDocuments", "duration: 1s\n---\nduration: 2s\n", "s.yaml:3: a second YAML document"},
    {"NoRobots", "duration: 1s\n", "s.yaml:1: the scenario lacks the key 'robots'"},
    {"EmptyRobots", "duration: 1s\nrobots: {}\n", "s.yaml:2: robots is empty"},
    {"NullRobots", "duration: 1s\nrobots:\n", "s.yaml:2: robots has no value"},
    {"EmptyClients", "duration: 1s\nrobots:\n  r:\n    clients: {}\n",
     "s.yaml:4: robots.r.clients is empty"},
    {"NoClients", "duration: 1s\nrobots:\n  r: {cpu: {}}\n",
     "s.yaml:3: robots.r lacks the key 'clients'"},
    {"DuplicateRobot", "duration: 1s\nrobots:\n  r: {clients: {c: {command: [sh]}}}\n  r: {}\n",
     "s.yaml:4: robots.r is given twice, first on line 3"},
    {"DynamicsWithoutBodies", "duration: 1s\ndynamics: {}\n" TCS_ROBOT,
     "s.yaml:2: dynamics has no bodies to move"},
    {"EmptyBodies", "duration: 1s\ndynamics: {}\nbodies: {}\n" TCS_ROBOT,
     "s.yaml:3: bodies is empty"},
    {"ChannelsWithoutWorld", "duration: 1s\n" TCS_ROBOT "channels:\n  c: {type: udp_json}\n",
     "s.yaml:4: channels.c needs bodies"},
    {"BodyWithoutWorld",
     "duration: 1s\nrobots: {r: {clients: {c: {command: [sh],\n                           body: "
     "b}}}}\n",
     "s.yaml:3: robots.r.clients.c.body names the body 'b', but the scenario has none"},
    {"NoListen",
     "duration: 1s\n" TCS_WORLD TCS_ROBOT "channels:\n  c: {type: udp_json, commands: {body: b}}\n",
     "s.yaml:6: channels.c.commands lacks the key 'listen'"},
    {"KeyIsAList", "duration: 1s\nrobots:\n  ? [a, b]\n  : 1\n", "s.yaml:3: robots has a key"},
};

INSTANTIATE_TEST_SUITE_P(All, WholeFileTest, testing::ValuesIn(kWholeFiles),
                         [](const auto& file) { return std::string(file.param.name); });

TEST(UnreadableFile, IsNamed) {
  const auto none = LoadScenario("/no/such/scenario.yaml");
  ASSERT_TRUE(std::holds_alternative<LoadError>(none));
  EXPECT_THAT(std::get<LoadError>(none).message,
              StartsWith("/no/such/scenario.yaml: cannot be read: No such file"));
  const auto folder = LoadScenario("/tmp");
  ASSERT_TRUE(std::holds_alternative<LoadError>(folder));
  EXPECT_THAT(std::get<LoadError>(folder).message, StartsWith("/tmp: cannot be read: Is a dir"));
  const auto endless = LoadScenario("/dev/zero");
  ASSERT_TRUE(std::holds_alternative<LoadError>(endless));
  EXPECT_THAT(std::get<LoadError>(endless).message, HasSubstr("larger than 1 MiB"));
}

TEST(LoadErrors, ATextWithoutEndIsCutInTheMiddle) {
  const ScenarioFolder folder;
  std::string endless;
  for (int i = 0; i < 20'000; ++i) endless += "\u00e9";
  const std::string path = folder.Write(
      "s.yaml", WithReplaced("listen: \"127.0.0.1:47011\"", "listen: \"1" + endless + ":47011\""));
  const auto loaded = LoadScenario(path);
  ASSERT_TRUE(std::holds_alternative<LoadError>(loaded));
  const std::string& message = std::get<LoadError>(loaded).message;
  EXPECT_LT(message.size(), path.size() + 2'100);
  EXPECT_THAT(message, HasSubstr("channels.hands.commands.listen has the address '1\u00e9"));
  EXPECT_THAT(message, HasSubstr("\u00e9 ... \u00e9"));
  EXPECT_TRUE(message.ends_with("write ADDRESS:PORT, like \"127.0.0.1:47010\"")) << message;
}

}  // namespace
}  // namespace tcs
