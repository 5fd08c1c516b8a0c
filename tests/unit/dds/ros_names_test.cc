#include "coordinator/dds/ros_names.h"

#include <gtest/gtest.h>

namespace tcs::dds {
namespace {

TEST(RosNames, TopicsAndTypesGoToDdsAndBack) {
  EXPECT_EQ(DdsTopic("/hunter/odom"), "rt/hunter/odom");
  EXPECT_EQ(RosTopic("rt/hunter/odom"), "/hunter/odom");
  EXPECT_EQ(DdsType("nav_msgs/msg/Odometry"), "nav_msgs::msg::dds_::Odometry_");
  EXPECT_EQ(RosType("nav_msgs::msg::dds_::Odometry_"), "nav_msgs/msg/Odometry");
}

TEST(RosNames, WhatIsNotRosKeepsItsName) {
  EXPECT_EQ(RosTopic("DDSPerfRDataKS"), "DDSPerfRDataKS");
  EXPECT_EQ(RosTopic("ros_discovery_info"), "ros_discovery_info");
  EXPECT_EQ(RosTopic("rthing"), "rthing");
  EXPECT_EQ(RosType("KeyedSeq"), "KeyedSeq");
  EXPECT_EQ(RosType("a::msg::dds_::"), "a::msg::dds_::");
}

TEST(RosNames, TheFolderOfMessagesMayBeLeftOut) {
  EXPECT_EQ(FullMessageName("nav_msgs/Odometry"), "nav_msgs/msg/Odometry");
  EXPECT_EQ(FullMessageName("nav_msgs/msg/Odometry"), "nav_msgs/msg/Odometry");
  EXPECT_EQ(FullMessageName("Odometry"), "Odometry");
}

TEST(RosNames, NamesOfScenariosBecomePartsOfThem) {
  EXPECT_EQ(RosToken("hunter"), "hunter");
  EXPECT_EQ(RosToken("r2-d2"), "r2_d2");
  EXPECT_EQ(RosToken("7"), "robot_7");
  EXPECT_EQ(RosToken("_x"), "robot_x") << "one that begins with '_' is hidden";
  for (const char* name : {"a.-b", "9.", "x_-_y", "a__b"}) {
    EXPECT_EQ(WhatIsWrongWithTopic("/" + RosToken(name) + "/tcsim"), std::nullopt) << name;
  }
}

TEST(RosNames, GoodTopicsAreGood) {
  for (const char* topic : {"/odom", "/a/b_c/d9", "/_hidden", "/X"}) {
    EXPECT_EQ(WhatIsWrongWithTopic(topic), std::nullopt) << topic;
  }
  EXPECT_EQ(WhatIsWrongWithTopic("/" + std::string(252, 'a')), std::nullopt);
}

TEST(RosNames, BadTopicsAreExplained) {
  EXPECT_EQ(WhatIsWrongWithTopic("odom"), "does not begin with '/'");
  EXPECT_EQ(WhatIsWrongWithTopic(""), "does not begin with '/'");
  EXPECT_EQ(WhatIsWrongWithTopic("/"), "ends with '/'");
  EXPECT_EQ(WhatIsWrongWithTopic("/odom/"), "ends with '/'");
  EXPECT_EQ(WhatIsWrongWithTopic("/a//b"), "has nothing between two '/'");
  EXPECT_EQ(WhatIsWrongWithTopic("/9lives"), "has a digit right after '/'");
  EXPECT_EQ(WhatIsWrongWithTopic("/a__b"), "has two '_' in a row");
  EXPECT_EQ(WhatIsWrongWithTopic("/a b"),
            "has a character other than letters, digits, '_' and '/'");
  EXPECT_EQ(WhatIsWrongWithTopic("/" + std::string(253, 'a')), "is longer than 253 characters");
}

}  // namespace
}  // namespace tcs::dds
