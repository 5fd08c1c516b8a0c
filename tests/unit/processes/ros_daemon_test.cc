#include "coordinator/processes/ros_daemon.h"

#include <gtest/gtest.h>

namespace tcs {
namespace {

TEST(RosDaemonTest, CommandsThatAskForNodesAndTopicsAskTheDaemonOfTheirDomain) {
  EXPECT_EQ(PortOfRosDaemon({"/usr/bin/python3", "/opt/ros/jazzy/bin/ros2", "topic", "list"}, ""),
            11511);
  EXPECT_EQ(PortOfRosDaemon({"ros2", "param", "get", "/rover", "speed"}, "7"), 11518);
  EXPECT_EQ(PortOfRosDaemon({"ros2", "topic", "echo", "/odom"}, "232"), 11743);
}

TEST(RosDaemonTest, OthersAskNobody) {
  EXPECT_EQ(PortOfRosDaemon({"python3", "ros2", "topic", "hz", "/odom"}, ""), std::nullopt);
  EXPECT_EQ(PortOfRosDaemon({"python3", "ros2", "topic", "list", "--no-daemon"}, ""), std::nullopt);
  EXPECT_EQ(PortOfRosDaemon({"python3", "ros2", "launch", "tcs", "hover.launch.py"}, ""),
            std::nullopt);
  EXPECT_EQ(PortOfRosDaemon({"python3", "ros2", "topic"}, ""), std::nullopt);
  EXPECT_EQ(PortOfRosDaemon({"python3", "x.py", "ros2", "topic", "list"}, ""), std::nullopt);
  EXPECT_EQ(PortOfRosDaemon({"ros2"}, ""), std::nullopt);
  EXPECT_EQ(PortOfRosDaemon({}, ""), std::nullopt);
  EXPECT_EQ(PortOfRosDaemon({"ros2", "node", "list"}, "233"), std::nullopt);  // ROS refuses it, too
}

TEST(RosDaemonTest, TheOneThatListensIsFound) {
  const std::string table =
      "  sl  local_address rem_address   st tx_queue rx_queue tr tm->when retrnsmt   uid  timeout "
      "inode\n"
      "   0: 0100007F:2CF7 00000000:0000 0A 00000000:00000000 00:00000000 00000000     0        0 "
      "4711 1 x 100 0 0 10 0\n"
      "   1: 0100007F:2CF8 0100007F:9999 01 00000000:00000000 00:00000000 00000000     0        0 "
      "4712 1 x 100 0 0 10 0\n"
      "   2: 00000000:2CF9 00000000:0000 0A 00000000:00000000 00:00000000 00000000     0        0 "
      "4713 1 x 100 0 0 10 0\n";
  EXPECT_EQ(ListenerAt(table, 11511), 4711u);
  EXPECT_EQ(ListenerAt(table, 11512), 0u);  // a connection
  EXPECT_EQ(ListenerAt(table, 11513), 4713u);
  EXPECT_EQ(ListenerAt(table, 11514), 0u);
  EXPECT_EQ(ListenerAt("", 11511), 0u);
}

}  // namespace
}  // namespace tcs
