// Looks up frames of /tf with timeouts: where a wheel is at the time when it asks, which is told a
// little later; and a frame that there is none of. Says what it found, and how long it waited.
#include <tf2_ros/buffer.h>
#include <tf2_ros/transform_listener.h>

#include <chrono>
#include <cstdio>
#include <memory>
#include <rclcpp/rclcpp.hpp>

int main(int argc, char** argv) {
  using namespace std::chrono_literals;
  rclcpp::init(argc, argv);
  const auto node = std::make_shared<rclcpp::Node>("frames");
  tf2_ros::Buffer buffer(node->get_clock());
  const tf2_ros::TransformListener listener(buffer);
  rclcpp::sleep_for(1s);
  for (const char* frame : {"left_wheel", "third_wheel"}) {
    const rclcpp::Time asked = node->now();
    const char* found = "not found";
    try {
      buffer.lookupTransform("world", frame, asked, rclcpp::Duration(500ms));
      found = "found";
    } catch (const tf2::TransformException&) {
    }
    std::printf("%s %s after %.1f ms\n", frame, found, (node->now() - asked).seconds() * 1e3);
  }
  rclcpp::shutdown();
}
