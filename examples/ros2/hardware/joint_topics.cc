#include "joint_topics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <pluginlib/class_list_macros.hpp>

namespace tcs {

namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
constexpr std::array<const char*, 3> kNames = {"position", "velocity", "effort"};

bool Has(const std::vector<hardware_interface::InterfaceInfo>& interfaces, const char* name) {
  return std::any_of(interfaces.begin(), interfaces.end(),
                     [name](const auto& interface) { return interface.name == name; });
}

std::string Parameter(const hardware_interface::HardwareInfo& info, const char* name) {
  const auto found = info.hardware_parameters.find(name);
  return found == info.hardware_parameters.end() ? "" : found->second;
}

}  // namespace

JointTopics::CallbackReturn JointTopics::on_init(const hardware_interface::HardwareInfo& info) {
  if (SystemInterface::on_init(info) != CallbackReturn::SUCCESS) return CallbackReturn::ERROR;
  const rclcpp::Logger logger = rclcpp::get_logger("JointTopics");
  for (const char* name : {"states", "commands"}) {
    if (!Parameter(info_, name).empty()) continue;
    RCLCPP_ERROR(logger, "%s has no topic: give its <hardware> a <param name=\"%s\">",
                 info_.name.c_str(), name);
    return CallbackReturn::ERROR;
  }
  joints_.clear();
  for (const auto& joint : info_.joints) {
    Interfaces& interfaces = joints_.emplace_back();
    for (std::size_t i = 0; i < kQuantities; ++i) {
      const std::string name = joint.name + "/" + kNames[i];
      if (Has(joint.state_interfaces, kNames[i])) interfaces.states[i] = name;
      if (Has(joint.command_interfaces, kNames[i])) interfaces.commands[i] = name;
    }
  }
  return AllCommandTheSame() ? CallbackReturn::SUCCESS : CallbackReturn::ERROR;
}

// One message has the commands of all joints: a list for each quantity, as long as the names, or
// empty.
bool JointTopics::AllCommandTheSame() const {
  for (std::size_t joint = 0; joint < joints_.size(); ++joint) {
    for (std::size_t i = 0; i < kQuantities; ++i) {
      if (joints_[joint].commands[i].empty() == joints_[0].commands[i].empty()) continue;
      RCLCPP_ERROR(rclcpp::get_logger("JointTopics"),
                   "%s: give all joints the command interface %s, or none: one message has it for "
                   "all of them",
                   info_.joints[joint].name.c_str(), kNames[i]);
      return false;
    }
  }
  return true;
}

JointTopics::CallbackReturn JointTopics::on_configure(const rclcpp_lifecycle::State&) {
  // The node is never spun: read() takes its messages.
  rclcpp::NodeOptions options;
  options.start_parameter_services(false).start_parameter_event_publisher(false);
  node_ = std::make_shared<rclcpp::Node>(info_.name + "_topics", options);
  measured_ =
      node_->create_subscription<JointState>(Parameter(info_, "states"), rclcpp::SensorDataQoS(),
                                             [this](const JointState& state) { Take(state); });
  wanted_ = node_->create_publisher<JointState>(Parameter(info_, "commands"), 1);
  return CallbackReturn::SUCCESS;
}

// What a controller commanded before counts no more.
JointTopics::CallbackReturn JointTopics::on_activate(const rclcpp_lifecycle::State&) {
  for (const Interfaces& joint : joints_) {
    for (const std::string& name : joint.commands) {
      if (!name.empty()) set_command(name, kUnknown);
    }
  }
  return CallbackReturn::SUCCESS;
}

hardware_interface::return_type JointTopics::read(const rclcpp::Time&, const rclcpp::Duration&) {
  JointState state;
  rclcpp::MessageInfo info;
  while (measured_ && measured_->take(state, info)) Take(state);
  return hardware_interface::return_type::OK;
}

void JointTopics::Take(const JointState& state) {
  const std::array<const std::vector<double>*, kQuantities> lists = {
      &state.position, &state.velocity, &state.effort};
  for (std::size_t place = 0; place < state.name.size(); ++place) {
    const auto joint =
        std::find_if(info_.joints.begin(), info_.joints.end(),
                     [&](const auto& known) { return known.name == state.name[place]; });
    if (joint == info_.joints.end()) continue;
    const Interfaces& interfaces = joints_[joint - info_.joints.begin()];
    for (std::size_t i = 0; i < kQuantities; ++i) {
      if (place < lists[i]->size() && !interfaces.states[i].empty())
        set_state(interfaces.states[i], (*lists[i])[place]);
    }
  }
}

hardware_interface::return_type JointTopics::write(const rclcpp::Time& time,
                                                   const rclcpp::Duration&) {
  JointState wanted;
  wanted.header.stamp = time;
  const std::array<std::vector<double>*, kQuantities> lists = {&wanted.position, &wanted.velocity,
                                                               &wanted.effort};
  bool all_known = true;
  for (std::size_t joint = 0; joint < joints_.size(); ++joint) {
    wanted.name.push_back(info_.joints[joint].name);
    for (std::size_t i = 0; i < kQuantities; ++i) {
      if (joints_[joint].commands[i].empty()) continue;
      lists[i]->push_back(get_command(joints_[joint].commands[i]));
      all_known = all_known && std::isfinite(lists[i]->back());
    }
  }
  if (all_known && wanted_) wanted_->publish(wanted);
  return hardware_interface::return_type::OK;
}

}  // namespace tcs

PLUGINLIB_EXPORT_CLASS(tcs::JointTopics, hardware_interface::SystemInterface)
