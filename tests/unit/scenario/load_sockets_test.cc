#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <variant>

#include "coordinator/scenario/load.h"
#include "tests/unit/scenario/scenario_folder.h"

namespace tcs {
namespace {

using testing::HasSubstr;

class LoadSocketsTest : public testing::Test {
 protected:
  // A scenario whose one channel of commands is on the UNIX socket.
  LoadResult<Scenario> Load(const std::string& listen) {
    return LoadScenario(
        folder_.Write("s.yaml",
                      "duration: 1\ndynamics: {}\nbodies: {b: {mass: 1, inertia: [1, 1, 1]}}\n"
                      "robots: {r: {clients: {c: {command: [sh]}}}}\nchannels:\n"
                      "  eyes: {type: unix_json, sensors: {bodies: [b], to: \"@eyes\"}}\n"
                      "  hands: {type: unix_json, commands: {body: b, listen: \"" +
                          listen + "\"}}\n"));
  }
  UnixName Loaded(const std::string& listen) {
    return std::get<UnixName>(ScenarioOf(Load(listen)).commands.at(0).from);
  }
  std::string Complaint(const std::string& listen) {
    const auto result = Load(listen);
    const auto* error = std::get_if<LoadError>(&result);
    return error == nullptr ? "" : error->message;
  }

  ScenarioFolder folder_;
};

TEST_F(LoadSocketsTest, PathsAreSeenFromTheScenario) {
  EXPECT_EQ(Loaded("hands").name, folder_.Path("hands"));
  EXPECT_EQ(Loaded("./a/../hands").name, folder_.Path("hands"));
  EXPECT_EQ(Loaded("/run/hands").name, "/run/hands");
  EXPECT_EQ(Loaded("${scenario_dir}/x").name, folder_.Path("x"));
  EXPECT_FALSE(Loaded("hands").is_abstract);
}

TEST_F(LoadSocketsTest, AnAbstractNameHasNoFolder) {
  EXPECT_EQ(Loaded("@hands").name, "hands");
  EXPECT_TRUE(Loaded("@hands").is_abstract);
  EXPECT_EQ(Loaded("@hands").Text(), "@hands");
}

// So that runs beside each other meet in no socket.
TEST_F(LoadSocketsTest, ARunHasNamesAndAnAddressOfItsOwn) {
  const std::string path = folder_.Write(
      "own.yaml",
      "duration: 1\ndynamics: {}\nbodies: {b: {mass: 1, inertia: [1, 1, 1]}}\n"
      "robots: {r: {clients: {c: {command: [sh, \"${run}/eyes\", \"${loopback}\"]}}}}\nchannels:\n"
      "  eyes: {type: unix_json, sensors: {bodies: [b], to: \"@${run}/eyes\"}}\n"
      "  hands: {type: udp_json, commands: {body: b, listen: \"${loopback}:5000\"}}\n");
  const auto load = [&](std::uint32_t run) { return ScenarioOf(LoadScenario(path, {.run = run})); };
  const Scenario one = load(0x1234abcd), next = load(0x1234abce);
  EXPECT_EQ(one.robots[0].clients[0].command[1], "1234abcd/eyes");
  EXPECT_EQ(std::get<UnixName>(one.sensors[0].to).name, "1234abcd/eyes");
  EXPECT_EQ(std::get<UnixName>(next.sensors[0].to).name, "1234abce/eyes");
  const auto from = std::get<UdpEndpoint>(one.commands[0].from);
  EXPECT_EQ(from.host, one.robots[0].clients[0].command[2]);
  EXPECT_EQ(from.port, 5000);
  EXPECT_TRUE(from.host.starts_with("127."));
  EXPECT_NE(from.host, std::get<UdpEndpoint>(next.commands[0].from).host);
  for (const std::uint32_t run : {0u, 155u, 156u, 4'000'000'000u}) {
    EXPECT_EQ(std::get<UdpEndpoint>(load(run).commands[0].from).host.size(), from.host.size())
        << "a program's arguments are as long in every run";
  }
}

TEST_F(LoadSocketsTest, LongNamesAreRefused) {
  EXPECT_EQ(Loaded("/" + std::string(106, 'x')).name.size(), 107u);
  EXPECT_THAT(Complaint("/" + std::string(107, 'x')),
              HasSubstr("s.yaml:7: channels.hands.commands.listen is '/xxx"));
  EXPECT_THAT(Complaint("/" + std::string(107, 'x')), HasSubstr("(107 bytes); choose a shorter"));
  EXPECT_EQ(Loaded("@" + std::string(107, 'x')).name.size(), 107u);
  EXPECT_THAT(Complaint("@" + std::string(108, 'x')), HasSubstr("longer than"));
}

TEST_F(LoadSocketsTest, EachChannelHasItsOwn) {
  EXPECT_THAT(Complaint("@eyes"),
              HasSubstr("again, which is that of channels.eyes.sensors.to on line 6; give each"));
}

TEST_F(LoadSocketsTest, NamesAreNotEmpty) {
  EXPECT_THAT(Complaint(""), HasSubstr("write the path of a UNIX socket, like eyes.sock"));
  EXPECT_THAT(Complaint("@"), HasSubstr("is '@'; write the path"));
}

}  // namespace
}  // namespace tcs
