// A snapshot says what the tables say, to the digit, and what is missing in one sentence.
#include "coordinator/snapshot/world_snapshot.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <stdlib.h>
#include <yaml-cpp/yaml.h>

#include <filesystem>
#include <fstream>
#include <variant>

#include "coordinator/snapshot/recorded_state.h"

namespace tcs::snapshot {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

constexpr const char* kHead =
    "time_s,body,x_m,y_m,z_m,qx,qy,qz,qw,vx_mps,vy_mps,vz_mps,wx_radps,wy_radps,wz_radps\n";
constexpr const char* kBodies =
    "0.000000000,ship,1,2,3,0,0,0,1,4,5,6,7,8,9\n"
    "0.000000000,arm/base,0,0,1,0,0,0,1,0,0,0,0,0,0\n"
    "0.000000000,arm/tip,0,0,2,0,0,0,1,0,0,0,0,0,0\n"
    "0.010000000,ship,1.1,-2.2e-17,3,0,0,0,1,4,5,6,7,8,9\n"
    "0.010000000,arm/base,0,0,1,0,0,0,1,0,0,0,0,0,0\n"
    "0.010000000,arm/tip,0,0,2,0,0,0,1,0,0,0,0,0,0\n";
constexpr const char* kJoints =
    "time_s,joint,position,velocity,effort\n"
    "0.000000000,arm/elbow,0.5,0,0\n"
    "0.010000000,arm/elbow,0.6000000000000001,-7,3\n";

std::string Scene(const char* kind, bool mimics = false) {
  return std::string(
             R"({"bodies":[{"name":"ship"}],"models":[{"name":"arm","root":0,"urdf":true,)") +
         R"("fixed_base":true,"links":[{"name":"arm/base"},{"name":"arm/tip","joint":"elbow",)" +
         R"("kind":")" + kind + "\"" + (mimics ? R"(,"mimics":true)" : "") + "}]}]}";
}

class SnapshotTest : public testing::Test {
 protected:
  SnapshotTest() {
    char folder[] = "/tmp/tcs-snapshot-XXXXXX";
    folder_ = mkdtemp(folder);
    Write("bodies.csv", std::string(kHead) + kBodies);
    Write("joints.csv", kJoints);
    Write("scene.json", Scene("revolute"));
  }
  ~SnapshotTest() override { fs::remove_all(folder_); }

  void Write(const std::string& file, const std::string& text) const {
    std::ofstream(folder_ + "/" + file) << text;
  }
  YAML::Node At(std::optional<std::int64_t> at_ns) const {
    const auto world = WorldAt(folder_, at_ns);
    if (const auto* error = std::get_if<LoadError>(&world)) {
      ADD_FAILURE() << error->message;
      return {};
    }
    return YAML::Load(std::get<std::string>(world));
  }
  std::string Complaint(std::optional<std::int64_t> at_ns) const {
    const auto world = WorldAt(folder_, at_ns);
    const auto* error = std::get_if<LoadError>(&world);
    if (error == nullptr) return {};
    EXPECT_EQ(error->message.find('\n'), std::string::npos);
    return error->message;
  }

  std::string folder_;
};

TEST_F(SnapshotTest, AnyNameThatARobotMayHaveIsReadBack) {
  const std::string scene = Scene("revolute");
  const std::string name = "joint: it's #1 [x]";
  Write("scene.json", std::string(scene).replace(scene.find("elbow"), 5, name));
  Write("joints.csv",
        "time_s,joint,position,velocity,effort\n0.000000000,arm/" + name + ",0.5,0,0\n");
  EXPECT_EQ(At(0)["models"]["arm"]["joints"][name][0].as<std::string>(), "0.5");
}

TEST_F(SnapshotTest, SaysWhatTheTablesSay) {
  const YAML::Node world = At(10'000'000);
  EXPECT_EQ(world["bodies"]["ship"]["position"][1].as<std::string>(), "-2.2e-17");
  EXPECT_EQ(world["bodies"]["ship"]["linear_velocity"][2].as<int>(), 6);
  EXPECT_EQ(world["bodies"]["ship"]["angular_velocity"][0].as<int>(), 7);
  EXPECT_EQ(world["bodies"]["ship"]["orientation"][3].as<int>(), 1);
  const YAML::Node elbow = world["models"]["arm"]["joints"]["elbow"];
  EXPECT_EQ(elbow[0].as<std::string>(), "0.6000000000000001");
  EXPECT_EQ(elbow[1].as<int>(), -7);
  EXPECT_FALSE(world["models"]["arm"]["at"]) << "it is fixed";
  EXPECT_EQ(At(0)["bodies"]["ship"]["position"][0].as<int>(), 1);
}

TEST_F(SnapshotTest, WithoutATimeItIsTheLastOneThatIsWhole) {
  EXPECT_EQ(At({})["bodies"]["ship"]["position"][0].as<double>(), 1.1);
  // A run that was killed.
  Write("bodies.csv",
        std::string(kHead) + kBodies + "0.020000000,ship,9,9,9,0,0,0,1,0,0,0,0,0,0\n");
  EXPECT_EQ(At({})["bodies"]["ship"]["position"][0].as<double>(), 1.1);
}

TEST_F(SnapshotTest, TheLastMomentIsOneThatAllTablesHave) {
  const std::string joints = kJoints;
  Write("joints.csv", joints.substr(0, joints.rfind("0.010000000")));
  const YAML::Node world = At({});
  EXPECT_EQ(world["bodies"]["ship"]["position"][0].as<double>(), 1);
  EXPECT_EQ(world["models"]["arm"]["joints"]["elbow"][0].as<double>(), 0.5);
}

TEST_F(SnapshotTest, AModelOfOneShapeAndAFreeRobotSayItTheirWay) {
  for (const char* urdf : {"true", "false"}) {
    Write("scene.json", std::string(R"({"bodies":[],"models":[{"name":"ship","root":0,"urdf":)") +
                            urdf + R"(,"fixed_base":false,"links":[{"name":"ship"}]}]})");
    const YAML::Node ship = At(0)["models"]["ship"];
    const YAML::Node pose = urdf[0] == 't' ? ship["at"] : ship;
    EXPECT_EQ(pose["position"][2].as<int>(), 3);
    EXPECT_EQ(ship["linear_velocity"][0].as<int>(), 4);
  }
}

TEST_F(SnapshotTest, AJointThatFollowsAnotherOneIsLeftToIt) {
  Write("scene.json", Scene("revolute", true));
  EXPECT_FALSE(At(0)["models"]);
}

TEST_F(SnapshotTest, WhatIsMissingIsSaid) {
  EXPECT_THAT(Complaint(5'000'000),
              HasSubstr("has no line of 0.005s: next to it are 0s and 0.01s"));
  EXPECT_THAT(Complaint(1'000'000'000), HasSubstr("next to it are 0.01s;"));
  Write("scene.json", Scene("planar"));
  fs::remove(folder_ + "/joints.csv");
  EXPECT_THAT(Complaint(0), HasSubstr("the planar joint 'elbow' of arm"));
  Write("scene.json", R"({"bodies":[{"name":"other"}],"models":[]})");
  EXPECT_THAT(Complaint(0), HasSubstr("no line of 'other'"));
  for (const char* scene :
       {"", "[]", R"({"bodies":{"a":1}})", R"({"bodies":[],"models":[{"links":3}]})"}) {
    Write("scene.json", scene);
    EXPECT_THAT(Complaint(0), HasSubstr("scene.json")) << scene;
  }
  fs::remove(folder_ + "/bodies.csv");
  EXPECT_THAT(Complaint({}), HasSubstr("give the folder of a run that had a world"));
}

TEST(SecondsText, IsExact) {
  EXPECT_EQ(SecondsText(0), "0s");
  EXPECT_EQ(SecondsText(12'500'000'000), "12.5s");
  EXPECT_EQ(SecondsText(1), "0.000000001s");
  EXPECT_EQ(SecondsText(100'000'000'000), "100s");
}

}  // namespace
}  // namespace tcs::snapshot
