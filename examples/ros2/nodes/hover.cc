// Holds the drone of hover.yaml at a point: reads odom, writes wrench. An ordinary node of rclcpp,
// which does not know of tcs.
#include <geometry_msgs/msg/wrench.hpp>
#include <memory>
#include <nav_msgs/msg/odometry.hpp>
#include <rclcpp/rclcpp.hpp>
#include <vector>

namespace {

using geometry_msgs::msg::Wrench;
using nav_msgs::msg::Odometry;

class Hover : public rclcpp::Node {
 public:
  Hover() : Node("hover") {
    goal_ = declare_parameter("goal", std::vector<double>{1, 2, 3});  // m
    stiffness_ = declare_parameter("stiffness", 4.0);                 // N/m
    damping_ = declare_parameter("damping", 4.0);                     // N*s/m
    wrench_ = create_publisher<Wrench>("wrench", 10);
    odometry_ = create_subscription<Odometry>(
        "odom", 10, [this](const Odometry& odometry) { wrench_->publish(Hold(odometry)); });
  }

 private:
  // The drone does not turn, so its own frame, in which the twist is, is the world's.
  Wrench Hold(const Odometry& odometry) const {
    const auto& at = odometry.pose.pose.position;
    const auto& velocity = odometry.twist.twist.linear;
    Wrench wrench;
    wrench.force.x = stiffness_ * (goal_[0] - at.x) - damping_ * velocity.x;
    wrench.force.y = stiffness_ * (goal_[1] - at.y) - damping_ * velocity.y;
    wrench.force.z = stiffness_ * (goal_[2] - at.z) - damping_ * velocity.z;
    return wrench;
  }

  std::vector<double> goal_;
  double stiffness_ = 0, damping_ = 0;
  rclcpp::Publisher<Wrench>::SharedPtr wrench_;
  rclcpp::Subscription<Odometry>::SharedPtr odometry_;
};

}  // namespace

int main(int argc, char** argv) {
  rclcpp::init(argc, argv);
  rclcpp::spin(std::make_shared<Hover>());
  rclcpp::shutdown();
}
