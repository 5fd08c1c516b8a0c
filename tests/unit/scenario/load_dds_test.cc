// What of a scenario stands on DDS, as it is written and as it is refused.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <ostream>

#include "coordinator/scenario/load.h"
#include "tests/unit/scenario/scenario_folder.h"
#include "tests/unit/times.h"

namespace tcs {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

class LoadDdsTest : public testing::Test {
 protected:
  Scenario Load(std::string_view text) {
    return ScenarioOf(LoadScenario(folder_.Write("s.yaml", text)));
  }

  ScenarioFolder folder_;
};

TEST_F(LoadDdsTest, SensorsAreAsWritten) {
  const Scenario scenario = Load(kGoodDdsScenario);
  ASSERT_EQ(scenario.sensors.size(), 2u);
  const SensorChannelSpec& odometry = scenario.sensors[0];
  const auto& to = std::get<DdsSensorEnd>(odometry.to);
  EXPECT_EQ(odometry.name, "odometry");
  EXPECT_EQ(to.message, dds::SensorMessage::kOdometry);
  EXPECT_THAT(odometry.bodies, ElementsAre(1));
  EXPECT_EQ(odometry.period, Ms(5));
  EXPECT_EQ(odometry.latency, Ms(2));
  EXPECT_EQ(to.end.topic, "/odom");
  EXPECT_EQ(to.end.domain, 3);
  dds::Qos qos;
  qos.reliability = dds::Reliability::kBestEffort;
  qos.depth = 5;
  qos.durability = dds::Durability::kTransientLocal;
  qos.deadline = Ms(20);
  qos.lifespan = Ms(1000);
  qos.lease = Ms(3000);
  EXPECT_EQ(to.end.qos, qos);
}

TEST_F(LoadDdsTest, SensorsHaveDefaults) {
  const SensorChannelSpec joints = Load(kGoodDdsScenario).sensors.at(1);
  const auto& to = std::get<DdsSensorEnd>(joints.to);
  EXPECT_EQ(to.message, dds::SensorMessage::kJointState);
  EXPECT_THAT(joints.bodies, ElementsAre(0, 1));
  EXPECT_EQ(joints.period, Ms(10));
  EXPECT_EQ(joints.latency, Ms(0));
  EXPECT_EQ(to.end.domain, 0);
  EXPECT_EQ(to.end.qos, dds::Qos());  // ROS 2's own: reliable, volatile, the last ten
}

TEST_F(LoadDdsTest, CommandsAreAsWritten) {
  const Scenario scenario = Load(kGoodDdsScenario);
  ASSERT_EQ(scenario.commands.size(), 2u);
  const CommandChannelSpec& thrust = scenario.commands[0];
  const DdsTopicSpec& topic = std::get<DdsCommandEnd>(thrust.from).end;
  EXPECT_EQ(thrust.name, "thrust");
  EXPECT_EQ(thrust.body, 1);
  EXPECT_EQ(thrust.latency, Ms(3));
  EXPECT_EQ(topic.topic, "/cmd");
  EXPECT_EQ(topic.domain, 3);
  EXPECT_EQ(topic.qos.reliability, dds::Reliability::kReliable);
  EXPECT_EQ(topic.qos.history, dds::History::kKeepAll);
  EXPECT_EQ(topic.qos.deadline, Ms(1000));
}

TEST_F(LoadDdsTest, CommandsAreReadFromEveryWriter) {
  const CommandChannelSpec push = Load(kGoodDdsScenario).commands.at(1);
  const DdsTopicSpec& topic = std::get<DdsCommandEnd>(push.from).end;
  EXPECT_EQ(topic.topic, "/push");
  EXPECT_EQ(topic.qos.reliability, dds::Reliability::kBestEffort);
  EXPECT_EQ(topic.qos.durability, dds::Durability::kVolatile);
  EXPECT_EQ(topic.qos.deadline, std::nullopt);
}

TEST_F(LoadDdsTest, TheClockIsAsWrittenOrWithDefaults) {
  const auto written = Load(kGoodDdsScenario).clock;
  ASSERT_TRUE(written);
  EXPECT_EQ(written->end.topic, "/sim/clock");
  EXPECT_EQ(written->end.domain, 7);
  EXPECT_EQ(written->period, Ms(20));
  const auto plain =
      Load(WithReplaced("{topic: /sim/clock, rate: 50, domain: 7}", "{}", kGoodDdsScenario)).clock;
  ASSERT_TRUE(plain);
  EXPECT_EQ(plain->end.topic, "/clock");
  EXPECT_EQ(plain->end.domain, 0);
  EXPECT_EQ(plain->end.qos.depth, 1);
  EXPECT_EQ(plain->period, Ms(10));
  EXPECT_FALSE(Load(kGoodScenario).clock);
}

TEST_F(LoadDdsTest, TheClockNeedsNoBodies) {
  EXPECT_TRUE(Load("duration: 1\nclock: {}\nrobots: {r: {clients: {c: {command: [sh]}}}}\n").clock);
}

TEST_F(LoadDdsTest, ClientsTalkByEndpointsUnlessTold) {
  const auto clients = Load(kGoodDdsScenario).robots.at(0).clients;
  EXPECT_EQ(clients[0].dds, DdsTransport::kSockets);
  EXPECT_EQ(clients[1].dds, DdsTransport::kEndpoints);
  EXPECT_EQ(clients[2].dds, DdsTransport::kEndpoints);
}

TEST_F(LoadDdsTest, OneTopicMayHaveTwoTypesInTwoDomains) {
  const Scenario scenario = Load(WithReplaced("/push", "/odom", kGoodDdsScenario));
  EXPECT_EQ(std::get<DdsCommandEnd>(scenario.commands[1].from).end.topic, "/odom");
}

TEST_F(LoadDdsTest, ChannelsOfBothTypesStandSideBySide) {
  const Scenario scenario = Load(std::string(kGoodDdsScenario) +
                                 "  eyes:\n    type: udp_json\n"
                                 "    sensors: {bodies: [prey], to: \"127.0.0.1:47010\"}\n");
  ASSERT_EQ(scenario.sensors.size(), 3u);
  EXPECT_TRUE(std::holds_alternative<DdsSensorEnd>(scenario.sensors[1].to));
  EXPECT_TRUE(std::holds_alternative<UdpEndpoint>(scenario.sensors[2].to));
}

// It may have others to talk to, so it is no mistake.
TEST_F(LoadDdsTest, AClientThatUsesSocketsOnAHostOfItsRobotsOwnIsWarnedOfTopicsThatAreNotThere) {
  EXPECT_THAT(Load(kGoodDdsScenario).warnings, IsEmpty());
  const auto in_network = [](std::string scenario) {
    return "network: {latency: 1ms}\n" + scenario;
  };
  EXPECT_THAT(Load(in_network(std::string(kGoodDdsScenario))).warnings,
              ElementsAre(AllOf(
                  HasSubstr("s.yaml:11: robots.hunter.clients.controller.dds is sockets"),
                  HasSubstr("the scenario's topics (/odom, /joint_states, /cmd and 2 more);"),
                  HasSubstr("remove `dds` for a Cyclone DDS program"), HasSubstr("udp_json"))));
  EXPECT_THAT(
      Load(in_network(WithReplaced("dds: sockets", "dds: endpoints", kGoodDdsScenario))).warnings,
      IsEmpty());
}

TEST_F(LoadDdsTest, TheReleaseOfRosDecidesTheFormOfWhatItsToolsAreTold) {
  EXPECT_EQ(Load(kGoodDdsScenario).ros, dds::RosRelease::kIron);
  const auto with = [this](const std::string& release) {
    return Load("ros: " + release + "\n" + std::string(kGoodDdsScenario)).ros;
  };
  EXPECT_EQ(with("humble"), dds::RosRelease::kHumble);
  for (const char* later : {"iron", "jazzy", "kilted", "rolling"}) {
    EXPECT_EQ(with(later), dds::RosRelease::kIron);
  }
}

struct WrongDds {
  std::string_view name;
  std::string_view from;  // in kGoodDdsScenario
  std::string_view to;
  int line;
  std::vector<std::string_view> words;
};

void PrintTo(const WrongDds& mistake, std::ostream* out) { *out << mistake.name; }

class DdsMistakeTest : public testing::TestWithParam<WrongDds> {};

TEST_P(DdsMistakeTest, IsOneSentenceWithItsPlace) {
  const ScenarioFolder folder;
  const WrongDds& mistake = GetParam();
  const std::string complaint =
      Complaint(folder, WithReplaced(mistake.from, mistake.to, kGoodDdsScenario));
  EXPECT_THAT(complaint, StartsWith("s.yaml:" + std::to_string(mistake.line) + ": "));
  for (const std::string_view words : mistake.words) {
    EXPECT_THAT(complaint, HasSubstr(std::string(words)));
  }
  EXPECT_EQ(complaint.find('\n'), std::string::npos);
}

const WrongDds kWrongDds[] = {
    {"UnknownTransport",
     "dds: sockets",
     "dds: socket",
     10,
     {"robots.hunter.clients.controller.dds is the unknown 'socket'", "'sockets'?"}},
    {"UnknownRelease",
     "name: pursuit\n",
     "ros: jazy\n",
     1,
     {"ros is the unknown 'jazy'", "did you mean 'jazzy'?"}},
    {"UnknownType",
     "  odometry:\n    type: dds",
     "  odometry:\n    type: ddz",
     16,
     {"channels.odometry.type is the unknown 'ddz'", "did you mean 'dds'?"}},
    {"KeyOfTheOtherType",
     "topic: /odom\n",
     "to: \"127.0.0.1:4\"\n",
     20,
     {"unknown key 'to' in channels.odometry.sensors"}},
    {"NoTopic", "      topic: /odom\n", "", 17, {"lacks the key 'topic'", "topic: /odom"}},
    {"NoMessage",
     "      message: nav_msgs/msg/Odometry\n",
     "",
     17,
     {"lacks the key 'message'", "nav_msgs/msg/Odometry"}},
    {"RelativeTopic",
     "topic: /odom\n",
     "topic: odom\n",
     20,
     {"channels.odometry.sensors.topic is 'odom'", "does not begin with '/'", "like /odom"}},
    {"TopicWithABlank", "topic: /odom\n", "topic: /my odom\n", 20, {"'/my odom'", "letters"}},
    {"SlipInTheMessage",
     "nav_msgs/msg/Odometry",
     "nav_msgs/msg/Odometri",
     19,
     {"is the unknown 'nav_msgs/msg/Odometri'", "did you mean 'nav_msgs/msg/Odometry'?"}},
    {"MessageOfNoKind",
     "nav_msgs/msg/Odometry",
     "std_msgs/msg/Empty",
     19,
     {"'std_msgs/msg/Empty'"}},
    {"SeveralBodiesInOneOdometry",
     "bodies: [prey]",
     "bodies: [prey, predator]",
     18,
     {"names 2 bodies, but nav_msgs/msg/Odometry tells of one", "a channel for each"}},
    {"UnknownBody", "bodies: [prey]", "bodies: [pray]", 18, {"'pray'", "'prey'?"}},
    {"RateOfZero", "rate: 200", "rate: 0", 21, {"rate is 0", "positive"}},
    {"DomainTooHigh",
     "latency: 2ms\n      domain: 3",
     "latency: 2ms\n      domain: 233",
     23,
     {"domain is '233'", "from 0 to 232"}},
    {"UnknownReliability",
     "reliability: best_effort",
     "reliability: best",
     24,
     {"qos.reliability is the unknown 'best'", "reliable and best_effort"}},
    {"UnknownHistory", "history: keep_last", "history: keep_lost", 24, {"'keep_last'?"}},
    {"UnknownDurability",
     "durability: transient_local",
     "durability: transient",
     24,
     {"durability is the unknown 'transient'"}},
    {"DepthOfZero", "depth: 5", "depth: 0", 24, {"depth is '0'", "from 1 to 1000000"}},
    {"DepthOfAll",
     "history: keep_last, depth: 5",
     "history: keep_all, depth: 5",
     24,
     {"qos.depth is for the history keep_last, but here it is keep_all"}},
    {"UnknownPolicy", "lease: 3s", "leas: 3s", 25, {"unknown key 'leas'", "'lease'?"}},
    {"DeadlineNobodyKeeps",
     "deadline: 20ms",
     "deadline: 4ms",
     25,
     {"deadline is shorter than the time between two samples", "rate higher"}},
    {"ZeroLifespan", "lifespan: 1s", "lifespan: 0s", 25, {"lifespan is 0s", "longer than 0"}},
    {"LifespanOfAReader",
     "history: keep_all, deadline: 1s",
     "history: keep_all, lifespan: 1s",
     37,
     {"channels.thrust.commands.qos.lifespan is for writers", "remove it"}},
    {"TwistAsACommand",
     "message: geometry_msgs/msg/Wrench",
     "message: geometry_msgs/msg/Twist",
     33,
     {"channels.thrust.commands.message is a velocity, but bodies are moved by forces",
      "geometry_msgs/msg/Wrench", "let a client turn"}},
    {"UnknownCommand",
     "message: geometry_msgs/msg/Wrench",
     "message: geometry_msgs/msg/Wrensh",
     33,
     {"'geometry_msgs/msg/Wrensh'", "did you mean 'geometry_msgs/msg/Wrench'?"}},
    {"OneTopicOfTwoTypes",
     "/push",
     "/joint_states",
     40,
     {"uses the topic /joint_states for geometry_msgs/msg/Wrench",
      "channels.joints.sensors.topic on line 28 uses it for sensor_msgs/msg/JointState"}},
    {"TheClocksTopicForOdometry",
     "{topic: /sim/clock, rate: 50, domain: 7}",
     "{topic: /odom, domain: 3}",
     20,
     {"uses the topic /odom for nav_msgs/msg/Odometry",
      "clock.topic on line 13 uses it for rosgraph_msgs/msg/Clock"}},
    {"UnknownKeyOfTheClock",
     "rate: 50, domain: 7",
     "period: 20ms",
     13,
     {"unknown key 'period' in clock"}},
    {"ClockWithoutValue",
     "clock: {topic: /sim/clock, rate: 50, domain: 7}",
     "clock:",
     13,
     {"clock has no value", "{} for none"}},
    {"BadClockTopic", "/sim/clock", "/sim/clock/", 13, {"clock.topic", "ends with '/'"}},
};

INSTANTIATE_TEST_SUITE_P(All, DdsMistakeTest, testing::ValuesIn(kWrongDds),
                         [](const auto& mistake) { return std::string(mistake.param.name); });

}  // namespace
}  // namespace tcs
