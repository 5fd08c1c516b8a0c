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
  const Values unknown = {kUnknown, kUnknown, kUnknown};
  states_.assign(info_.joints.size(), unknown);
  commands_.assign(info_.joints.size(), unknown);
  for (std::size_t i = 0; i < kQuantities; ++i) {
    commanded_[i] = !info_.joints.empty() && Has(info_.joints[0].command_interfaces, kNames[i]);
    for (const auto& joint : info_.joints) {
      if (Has(joint.command_interfaces, kNames[i]) == commanded_[i]) continue;
      RCLCPP_ERROR(logger,
                   "%s: give all joints the command interface %s, or none: one message has it for "
                   "all of them",
                   joint.name.c_str(), kNames[i]);
      return CallbackReturn::ERROR;
    }
  }
  return CallbackReturn::SUCCESS;
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

JointTopics::CallbackReturn JointTopics::on_activate(const rclcpp_lifecycle::State&) {
  for (Values& command : commands_) command.fill(kUnknown);
  return CallbackReturn::SUCCESS;
}

std::vector<hardware_interface::StateInterface> JointTopics::export_state_interfaces() {
  std::vector<hardware_interface::StateInterface> interfaces;
  for (std::size_t joint = 0; joint < states_.size(); ++joint) {
    for (std::size_t i = 0; i < kQuantities; ++i) {
      if (Has(info_.joints[joint].state_interfaces, kNames[i]))
        interfaces.emplace_back(info_.joints[joint].name, kNames[i], &states_[joint][i]);
    }
  }
  return interfaces;
}

std::vector<hardware_interface::CommandInterface> JointTopics::export_command_interfaces() {
  std::vector<hardware_interface::CommandInterface> interfaces;
  for (std::size_t joint = 0; joint < commands_.size(); ++joint) {
    for (std::size_t i = 0; i < kQuantities; ++i) {
      if (commanded_[i])
        interfaces.emplace_back(info_.joints[joint].name, kNames[i], &commands_[joint][i]);
    }
  }
  return interfaces;
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
    Values& values = states_[joint - info_.joints.begin()];
    for (std::size_t i = 0; i < kQuantities; ++i) {
      if (place < lists[i]->size()) values[i] = (*lists[i])[place];
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
  for (std::size_t joint = 0; joint < commands_.size(); ++joint) {
    wanted.name.push_back(info_.joints[joint].name);
    for (std::size_t i = 0; i < kQuantities; ++i) {
      if (!commanded_[i]) continue;
      lists[i]->push_back(commands_[joint][i]);
      all_known = all_known && std::isfinite(commands_[joint][i]);
    }
  }
  if (all_known && wanted_) wanted_->publish(wanted);
  return hardware_interface::return_type::OK;
}

}  // namespace tcs

PLUGINLIB_EXPORT_CLASS(tcs::JointTopics, hardware_interface::SystemInterface)
