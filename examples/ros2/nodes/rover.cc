// Drives the rover of rover.yaml to and fro in its hall: reads odom and scan, writes cmd_vel. Heads
// for the end of the hall, and turns away from what stands in its way. An ordinary node of rclcpp,
// which does not know of tcs.
#include <algorithm>
#include <cmath>
#include <geometry_msgs/msg/twist.hpp>
#include <memory>
#include <nav_msgs/msg/odometry.hpp>
#include <rclcpp/rclcpp.hpp>
#include <sensor_msgs/msg/laser_scan.hpp>

namespace {

using geometry_msgs::msg::Twist;
using nav_msgs::msg::Odometry;
using sensor_msgs::msg::LaserScan;

class Rover : public rclcpp::Node {
 public:
  Rover() : Node("rover") {
    half_way_ =
        declare_parameter("half_way", 5.0);    // m from the middle of the hall to where it turns
    speed_ = declare_parameter("speed", 0.6);  // m/s
    clearance_ = declare_parameter("clearance", 1.2);  // m, within which it turns away
    command_ = create_publisher<Twist>("cmd_vel", 10);
    odometry_ = create_subscription<Odometry>("odom", 10, [this](const Odometry& o) { at_ = o; });
    scan_ = create_subscription<LaserScan>(
        "scan", rclcpp::SensorDataQoS(),
        [this](const LaserScan& scan) { command_->publish(Drive(scan)); });
  }

 private:
  Twist Drive(const LaserScan& scan) {
    const auto& at = at_.pose.pose.position;
    if (goal_ * at.x > half_way_) {
      goal_ = -goal_;
      RCLCPP_INFO(get_logger(), "turns at x = %.2f m", at.x);
    }
    // The free direction that is nearest to the goal's.
    const double wanted = Wrapped(std::atan2(-at.y, goal_ * (half_way_ + 1) - at.x) - Yaw());
    double best = wanted >= 0 ? 1.5 : -1.5, cost = 1e9;
    for (double direction = -1.5; direction <= 1.5; direction += 0.1) {
      const double to_turn = std::abs(Wrapped(direction - wanted));
      if (IsFree(scan, direction) && to_turn < cost) best = direction, cost = to_turn;
    }
    Twist twist;
    twist.linear.x = std::abs(best) < 0.8 && cost < 1e9 ? speed_ * std::cos(best) : 0.0;
    twist.angular.z = std::clamp(2.0 * best, -1.5, 1.5);
    return twist;
  }

  // Whether nothing is within the rover's width in that direction.
  bool IsFree(const LaserScan& scan, double direction) const {
    constexpr double kHalfWidth = 0.3;  // m
    for (std::size_t i = 0; i < scan.ranges.size(); ++i) {
      const double from = Wrapped(scan.angle_min + i * scan.angle_increment - direction);
      const double range = scan.ranges[i];
      if (!std::isfinite(range) || std::abs(from) > 1.5) continue;
      if (range * std::cos(from) < clearance_ && std::abs(range * std::sin(from)) < kHalfWidth)
        return false;
    }
    return true;
  }

  double Yaw() const {
    const auto& q = at_.pose.pose.orientation;
    return std::atan2(2 * (q.w * q.z + q.x * q.y), 1 - 2 * (q.y * q.y + q.z * q.z));
  }
  static double Wrapped(double angle) { return std::remainder(angle, 2 * M_PI); }

  double half_way_ = 0, speed_ = 0, clearance_ = 0;
  double goal_ = 1;  // the end of the hall that it drives to: -1 or 1
  Odometry at_;
  rclcpp::Publisher<Twist>::SharedPtr command_;
  rclcpp::Subscription<Odometry>::SharedPtr odometry_;
  rclcpp::Subscription<LaserScan>::SharedPtr scan_;
};

}  // namespace

int main(int argc, char** argv) {
  rclcpp::init(argc, argv);
  rclcpp::spin(std::make_shared<Rover>());
  rclcpp::shutdown();
}
