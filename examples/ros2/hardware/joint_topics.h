// The joints of a robot for ros2_control, by two topics of sensor_msgs/msg/JointState: one tells
// where they are, the other takes what they are to do. In a scenario of tcs these are two channels
// about the joints of a model. On a robot they may be anybody's.
//
// In the URDF, in <hardware> of <ros2_control type="system">:
//   <plugin>tcs/JointTopics</plugin>
//   <param name="states">/arm/measured</param>      where the joints are
//   <param name="commands">/arm/commands</param>    what they are to do
// Each joint has state interfaces of position, velocity and effort, and command interfaces of any
// of these; all joints have the same ones.
//
// Not for several threads: the controller manager calls read() and write() one after the other.
// Neither waits.
#pragma once

#include <array>
#include <hardware_interface/system_interface.hpp>
#include <memory>
#include <rclcpp/rclcpp.hpp>
#include <sensor_msgs/msg/joint_state.hpp>
#include <string>
#include <vector>

namespace tcs {

class JointTopics : public hardware_interface::SystemInterface {
 public:
  using CallbackReturn = rclcpp_lifecycle::node_interfaces::LifecycleNodeInterface::CallbackReturn;

  CallbackReturn on_init(const hardware_interface::HardwareInfo& info) override;
  CallbackReturn on_configure(const rclcpp_lifecycle::State& previous) override;
  CallbackReturn on_activate(const rclcpp_lifecycle::State& previous) override;

  // Takes what has come since; the newest value of each joint counts.
  hardware_interface::return_type read(const rclcpp::Time& time,
                                       const rclcpp::Duration& period) override;
  // Says nothing until a controller has commanded each joint.
  hardware_interface::return_type write(const rclcpp::Time& time,
                                        const rclcpp::Duration& period) override;

 private:
  static constexpr std::size_t kQuantities = 3;  // position, velocity, effort
  using JointState = sensor_msgs::msg::JointState;
  // Of one joint, the names of its interfaces, `shoulder/position`; empty: it has none of that.
  struct Interfaces {
    std::array<std::string, kQuantities> states, commands;
  };

  bool AllCommandTheSame() const;
  void Take(const JointState& state);

  std::vector<Interfaces> joints_;  // as in info_.joints
  rclcpp::Node::SharedPtr node_;
  rclcpp::Subscription<JointState>::SharedPtr measured_;
  rclcpp::Publisher<JointState>::SharedPtr wanted_;
};

}  // namespace tcs
