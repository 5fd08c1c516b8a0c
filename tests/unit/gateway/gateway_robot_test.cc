#include "coordinator/gateway/gateway_robot.h"

#include <gmock/gmock.h>

#include <optional>
#include <string>
#include <vector>

#include "coordinator/gateway/served_end.h"

namespace tcs {
namespace {

using gateway::FromText;
using gateway::ServedEnd;
using gateway::ToText;

constexpr const char* kShim = "/usr/lib/tcs/libtcs_preload.so";
constexpr std::size_t kEndsFrom = 3;  // of the command

Scenario OnDds(DdsTransport transport) {
  Scenario scenario;
  RobotSpec& robot = scenario.robots.emplace_back();
  robot.name = "hunter";
  ClientSpec& client = robot.clients.emplace_back();
  client.name = "hunter/controller";
  client.dds = transport;
  client.body = 0;
  return scenario;
}

SensorChannelSpec Odometry(const std::string& topic) {
  SensorChannelSpec sensor;
  sensor.bodies = {0};
  sensor.to = DdsSensorEnd{{.topic = topic}, dds::SensorMessage::kOdometry};
  return sensor;
}

std::vector<ServedEnd> EndsOf(const RobotSpec& robot) {
  const std::vector<std::string>& command = robot.clients.front().command;
  std::vector<ServedEnd> ends;
  for (std::size_t i = kEndsFrom; i < command.size(); ++i)
    ends.push_back(FromText(command[i]).value());
  return ends;
}

TEST(ServedEndTest, IsWhatItsTextSays) {
  ServedEnd end{.is_sensor = true,
                .domain = 7,
                .topic = "rt/odom",
                .type = "nav_msgs::msg::dds_::Odometry_",
                .user_data = "typehash=RIHS01_3c;",
                .name_space = "/hunter"};
  EXPECT_EQ(FromText(ToText(end)), end);
  end = {.topic = "rt/cmd", .type = "T", .name_space = "/"};
  end.qos = {dds::Reliability::kBestEffort, dds::History::kKeepAll, 3,
             dds::Durability::kTransientLocal, dds::Liveliness::kManualByTopic};
  end.qos.deadline = VirtualDuration::Milliseconds(20);
  end.qos.lifespan = VirtualDuration::Seconds(1);
  end.qos.lease = VirtualDuration::Seconds(3);
  EXPECT_EQ(FromText(ToText(end)), end);
  EXPECT_EQ(FromText(""), std::nullopt);
  EXPECT_EQ(FromText("sensor 0 rt/odom"), std::nullopt);
}

TEST(GatewayRobotTest, IsThereWhereAClientBySocketsCanMeetTopics) {
  Scenario scenario = OnDds(DdsTransport::kSockets);
  EXPECT_FALSE(GatewayRobot(scenario, kShim).has_value()) << "there is no topic";
  scenario.sensors.push_back(Odometry("/odom"));
  EXPECT_TRUE(GatewayRobot(scenario, kShim).has_value());
  scenario.network.emplace();
  EXPECT_FALSE(GatewayRobot(scenario, kShim).has_value()) << "robots have hosts of their own";
  scenario = OnDds(DdsTransport::kEndpoints);
  scenario.sensors.push_back(Odometry("/odom"));
  EXPECT_FALSE(GatewayRobot(scenario, kShim).has_value()) << "nobody uses sockets";
}

TEST(GatewayRobotTest, ServesEachTopicOnceAndTakesNoTime) {
  Scenario scenario = OnDds(DdsTransport::kSockets);
  scenario.robots.front().clients.front().environment["CYCLONEDDS_URI"] = "<its/>";
  scenario.sensors = {Odometry("/odom"), Odometry("/odom")};
  std::get<DdsSensorEnd>(scenario.sensors[1].to).end.qos.reliability =
      dds::Reliability::kBestEffort;
  CommandChannelSpec& command = scenario.commands.emplace_back();
  command.from = DdsCommandEnd{{.topic = "/wrench"}, dds::CommandMessage::kWrench};
  scenario.clock.emplace().end.topic = "/clock";
  const std::optional<RobotSpec> robot = GatewayRobot(scenario, kShim);
  ASSERT_TRUE(robot.has_value());
  EXPECT_TRUE(robot->is_ideal && robot->is_ours);
  const ClientSpec& client = robot->clients.front();
  EXPECT_EQ(client.command[0], "/usr/lib/tcs/tcs-dds-gateway");
  EXPECT_THAT(client.environment.at("CYCLONEDDS_URI"), testing::StartsWith("<its/>,"));
  const std::vector<ServedEnd> ends = EndsOf(*robot);
  ASSERT_EQ(ends.size(), 3u);
  EXPECT_TRUE(ends[0].is_sensor && !ends[1].is_sensor && ends[2].is_sensor);
  EXPECT_EQ(ends[0].topic, "rt/odom");
  EXPECT_EQ(ends[0].name_space, "/hunter");
  EXPECT_EQ(ends[0].qos.reliability, dds::Reliability::kBestEffort) << "matches both channels";
  EXPECT_EQ(ends[1].type, "geometry_msgs::msg::dds_::Wrench_");
  EXPECT_EQ(ends[2].name_space, "/");
}

}  // namespace
}  // namespace tcs
