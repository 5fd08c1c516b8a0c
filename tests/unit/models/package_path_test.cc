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

TEST_F(PackagePathTest, WhatIsNotThereIsSaid) {
  EXPECT_THAT(Find("package://others/x", {"/nowhere"}),
              HasSubstr("'package://others/x' is in the package 'others', which is in none of 1 "
                        "folders of packages"));
  EXPECT_THAT(Find("package://others"), HasSubstr("names no file in a package"));
  EXPECT_THAT(Find("package:///x"), HasSubstr("names no file in a package"));
  EXPECT_THAT(Find("package://"), HasSubstr("no file"));
  EXPECT_THAT(Find("http://example.org/x.stl"), HasSubstr("names no file on this computer"));
}

}  // namespace
}  // namespace tcs
