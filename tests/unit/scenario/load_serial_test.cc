#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <variant>

#include "coordinator/scenario/load.h"
#include "tests/unit/scenario/scenario_folder.h"

namespace tcs {
namespace {

using testing::HasSubstr;

class LoadSerialTest : public testing::Test {
 protected:
  LoadResult<Scenario> Load(const std::string& sensors, const std::string& commands,
                            const std::string& robots = "r: {clients: {c: {command: [sh]}}}") {
    return LoadScenario(
        folder_.Write("s.yaml",
                      "duration: 1\ndynamics: {}\nbodies: {b: {mass: 1, inertia: [1, 1, 1]}}\n"
                      "robots: {" +
                          robots +
                          "}\nchannels:\n"
                          "  eyes: {type: pty, sensors: {bodies: [b], " +
                          sensors +
                          "}}\n"
                          "  hands: {type: pty, commands: {body: b, " +
                          commands + "}}\n"));
  }
  std::string Complaint(const std::string& sensors, const std::string& commands,
                        const std::string& robots = "r: {clients: {c: {command: [sh]}}}") {
    const auto result = Load(sensors, commands, robots);
    const auto* error = std::get_if<LoadError>(&result);
    return error == nullptr ? "" : error->message;
  }

  ScenarioFolder folder_;
};

TEST_F(LoadSerialTest, ChannelsOnOneDeviceShareItsLine) {
  const Scenario scenario =
      ScenarioOf(Load("device: /dev/ttyS1, baud: 9600, frame: 7E2, fifo: 8", "device: /dev/ttyS1"));
  const auto& to = std::get<SerialPort>(scenario.sensors.at(0).to);
  const auto& from = std::get<SerialPort>(scenario.commands.at(0).from);
  EXPECT_EQ(to.robot, "r");
  EXPECT_EQ(to.path, "/dev/ttyS1");
  for (const SerialPort& port : {to, from}) {
    EXPECT_EQ(port.baud, 9600);
    EXPECT_EQ(port.frame_bits, 1 + 7 + 1 + 2);
    EXPECT_EQ(port.fifo, 8);
  }
}

TEST_F(LoadSerialTest, LinesHaveDefaults) {
  const Scenario scenario = ScenarioOf(Load("device: /dev/a", "device: /dev/b"));
  const auto& port = std::get<SerialPort>(scenario.sensors.at(0).to);
  EXPECT_EQ(port.baud, 115'200);
  EXPECT_EQ(port.frame_bits, 10);
  EXPECT_EQ(port.fifo, 1);
}

TEST_F(LoadSerialTest, ALineHasOneRate) {
  EXPECT_THAT(Complaint("device: /dev/a, baud: 9600", "device: /dev/a, baud: 19200"),
              HasSubstr("s.yaml:7: channels.hands.commands.baud differs from that of "
                        "channels.eyes.sensors on line 6 for the same device"));
}

TEST_F(LoadSerialTest, SeveralRobotsMeanThatOneIsNamed) {
  const std::string two = "r: {clients: {c: {command: [sh]}}}, q: {clients: {c: {command: [sh]}}}";
  EXPECT_THAT(Complaint("device: /dev/a", "device: /dev/a", two),
              HasSubstr("channels.eyes.sensors lacks the key 'robot'"));
  EXPECT_THAT(Complaint("device: /dev/a, robot: rr", "device: /dev/a, robot: q", two),
              HasSubstr("names the unknown robot 'rr'; "));
  const Scenario scenario =
      ScenarioOf(Load("device: /dev/a, robot: q", "device: /dev/a, robot: r, baud: 300", two));
  EXPECT_EQ(std::get<SerialPort>(scenario.sensors.at(0).to).robot, "q");
  EXPECT_EQ(std::get<SerialPort>(scenario.sensors.at(0).to).baud, 115'200);
}

TEST_F(LoadSerialTest, WhatIsNoDeviceOrLineIsNamed) {
  EXPECT_THAT(Complaint("device: ttyUSB0", "device: /dev/a"),
              HasSubstr("is 'ttyUSB0'; write the whole path"));
  EXPECT_THAT(Complaint("device: /dev/a, frame: 9N1", "device: /dev/a"),
              HasSubstr("channels.eyes.sensors.frame is '9N1'; write data bits"));
  EXPECT_THAT(Complaint("device: /dev/a, baud: 3", "device: /dev/a"),
              HasSubstr("baud is '3'; it must be"));
  EXPECT_THAT(Complaint("device: /dev/a, to: x", "device: /dev/a"), HasSubstr("unknown key 'to'"));
}

}  // namespace
}  // namespace tcs
