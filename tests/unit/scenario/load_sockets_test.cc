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
