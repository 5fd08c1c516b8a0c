#include "coordinator/models/package_path.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <stdlib.h>

#include "coordinator/models/model_mistake.h"
#include "tests/unit/models/model_folder.h"

namespace tcs {
namespace {

using testing::HasSubstr;

class PackagePathTest : public testing::Test {
 protected:
  PackagePathTest() {
    unsetenv("ROS_PACKAGE_PATH");
    unsetenv("AMENT_PREFIX_PATH");
    folder_.Write("robots/mine/urdf/a.urdf", "");
    folder_.Write("robots/mine/meshes/a.stl", "");
    folder_.Write("ros1/theirs/b.stl", "");
    folder_.Write("ros2/share/theirs/c.stl", "");
    folder_.Write("given/theirs/d.stl", "");
  }
  ~PackagePathTest() override {
    unsetenv("ROS_PACKAGE_PATH");
    unsetenv("AMENT_PREFIX_PATH");
  }

  std::string Find(const std::string& name, std::vector<std::string> folders = {}) const {
    try {
      return PackagePath(std::move(folders)).Find(name, folder_.Path("robots/mine/urdf/a.urdf"));
    } catch (const ModelMistake& mistake) {
      return mistake.message;
    }
  }

  ModelFolder folder_;
};

TEST_F(PackagePathTest, APathIsSeenFromTheDescription) {
  EXPECT_EQ(Find("b.stl"), folder_.Path("robots/mine/urdf/b.stl"));
  EXPECT_EQ(Find("../meshes/a.stl"), folder_.Path("robots/mine/meshes/a.stl"));
  EXPECT_EQ(Find("/x/y.stl"), "/x/y.stl");
  EXPECT_EQ(Find("file:///x/y.stl"), "/x/y.stl");
}

TEST_F(PackagePathTest, APackageMayBeAFolderThatTheDescriptionIsIn) {
  EXPECT_EQ(Find("package://mine/meshes/a.stl"), folder_.Path("robots/mine/meshes/a.stl"));
  EXPECT_EQ(Find("model://mine/meshes/a.stl"), folder_.Path("robots/mine/meshes/a.stl"));
}

TEST_F(PackagePathTest, GivenFoldersComeBeforeRos1BeforeRos2) {
  setenv("AMENT_PREFIX_PATH", folder_.Path("ros2").c_str(), 1);
  EXPECT_EQ(Find("package://theirs/x"), folder_.Path("ros2/share/theirs/x"));
  setenv("ROS_PACKAGE_PATH", ("/nowhere::" + folder_.Path("ros1") + "/").c_str(), 1);
  EXPECT_EQ(Find("package://theirs/x"), folder_.Path("ros1/theirs/x"));
  EXPECT_EQ(Find("package://theirs/x", {folder_.Path("given")}), folder_.Path("given/theirs/x"));
}

TEST_F(PackagePathTest, AFolderOfThePathMayBeThePackageItself) {
  EXPECT_EQ(Find("package://theirs/x", {folder_.Path("given/theirs/")}),
            folder_.Path("given/theirs/x"));
}

TEST_F(PackagePathTest, APackageIsWhatItsPackageXmlSays) {
  // A clone under another name, deep in a workspace; beside it a folder that nobody looks into.
  folder_.Write(
      "ws/src/group/clone/package.xml",
      "<?xml version='1.0'?><package format='2'><name> arm_description </name></package>");
  folder_.Write("ws/src/group/clone/meshes/e.stl", "");
  folder_.Write("ws/build/COLCON_IGNORE", "");
  folder_.Write("ws/build/copy/package.xml", "<package><name>arm_description</name></package>");
  folder_.Write("ws/build/copy/meshes/e.stl", "");
  const std::string there = folder_.Path("ws/src/group/clone/meshes/e.stl");
  EXPECT_EQ(Find("package://arm_description/meshes/e.stl", {folder_.Path("ws")}), there);
  setenv("ROS_PACKAGE_PATH", folder_.Path("ws").c_str(), 1);
  EXPECT_EQ(Find("package://arm_description/meshes/e.stl"), there);
}

// A repository of descriptions is cloned, and nothing is set.
TEST_F(PackagePathTest, APackageIsFoundUpwardsFromTheDescription) {
  folder_.Write("robots/.git/HEAD", "");
  folder_.Write("robots/beside/meshes/f.stl", "");
  folder_.Write("robots/more/grippers/hand/package.xml",
                "<package><name>hand_description</name></package>");
  folder_.Write("robots/more/grippers/hand/g.stl", "");
  EXPECT_EQ(Find("package://beside/meshes/f.stl"), folder_.Path("robots/beside/meshes/f.stl"));
  EXPECT_EQ(Find("package://hand_description/g.stl"),
            folder_.Path("robots/more/grippers/hand/g.stl"));
  // The description's own package under another name, without a package.xml.
  EXPECT_EQ(Find("package://renamed/meshes/a.stl"), folder_.Path("robots/mine/meshes/a.stl"));
}

TEST_F(PackagePathTest, OfTwoFoldersTheOneThatHasTheFileIsTaken) {
  folder_.Write("empty/theirs/other.stl", "");
  EXPECT_EQ(Find("package://theirs/d.stl", {folder_.Path("empty"), folder_.Path("given")}),
            folder_.Path("given/theirs/d.stl"));
}

TEST_F(PackagePathTest, NamesAreTakenAsTheyAreMeant) {
  folder_.Write("robots/mine/meshes/left arm.stl", "");
  const std::string there = folder_.Path("robots/mine/meshes/left arm.stl");
  EXPECT_EQ(Find("package://mine/meshes/left%20arm.stl"), there);
  EXPECT_EQ(Find("package:///mine//meshes/left arm.stl"), there);
  EXPECT_EQ(Find("..\\meshes\\left arm.stl"), there);
  EXPECT_EQ(Find("file://" + there), there);
  EXPECT_EQ(Find("meshes/left%20arm.stl"), there);  // as seen from the package
  folder_.Write("robots/mine/meshes/a%20b.stl", "");
  EXPECT_EQ(Find("../meshes/a%20b.stl"), folder_.Path("robots/mine/meshes/a%20b.stl"));
}

TEST_F(PackagePathTest, WhatIsNotThereIsSaid) {
  EXPECT_THAT(
      Find("package://others/x", {"/nowhere"}),
      HasSubstr("'package://others/x' is in the package 'others', which is in none of these "
                "folders: /nowhere, " +
                folder_.Path("robots/mine/urdf")));
  EXPECT_THAT(Find("package://others"), HasSubstr("names no file in a package"));
  EXPECT_THAT(Find("package:///x"), HasSubstr("names no file in a package"));
  EXPECT_THAT(Find("package://../x"), HasSubstr("names no file in a package"));
  EXPECT_THAT(Find("package://"), HasSubstr("no file"));
  EXPECT_THAT(Find("http://example.org/x.stl"), HasSubstr("names no file on this computer"));
}

}  // namespace
}  // namespace tcs
