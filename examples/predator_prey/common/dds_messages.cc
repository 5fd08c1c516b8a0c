#include "examples/predator_prey/common/dds_messages.h"

#include <span>

namespace predator_prey {
namespace {

using Vector3Message = geometry_msgs_msg_dds__Vector3_;
using PoseMessage = geometry_msgs_msg_dds__Pose_;
using TwistMessage = geometry_msgs_msg_dds__Twist_;
using BodyStateMessage = predator_prey_msgs_msg_dds__BodyState_;
using PlanStepMessage = predator_prey_msgs_msg_dds__PlanStep_;

Vector3Message ToVector3(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

Eigen::Vector3d ToVector(const Vector3Message& v) { return {v.x, v.y, v.z}; }

// At the pose, at rest.
BodyState AtPose(const PoseMessage& pose) {
  const auto& [position, q] = pose;
  BodyState body;
  body.position_m = {position.x, position.y, position.z};
  body.orientation = {q.w, q.x, q.y, q.z};
  return body;
}

BodyStateMessage ToMessage(const BodyState& body) {
  const Eigen::Vector3d& at = body.position_m;
  const Eigen::Quaterniond& q = body.orientation;
  const PoseMessage pose{{at.x(), at.y(), at.z()}, {q.x(), q.y(), q.z(), q.w()}};
  const TwistMessage twist{ToVector3(body.linear_velocity_mps),
                           ToVector3(body.angular_velocity_radps)};
  return {pose, twist};
}

BodyState FromMessage(const BodyStateMessage& message) {
  BodyState body = AtPose(message.pose);
  body.linear_velocity_mps = ToVector(message.twist.linear);
  body.angular_velocity_radps = ToVector(message.twist.angular);
  return body;
}

PlanStepMessage ToMessage(const PlanStep& step) {
  return {step.duration_s, predator_prey::ToMessage(step.control), ToMessage(step.expected)};
}

PlanStep FromMessage(const PlanStepMessage& message) {
  return {.duration_s = message.duration,
          .control = {.force_n = ToVector(message.control.force),
                      .torque_nm = ToVector(message.control.torque)},
          .expected = FromMessage(message.expected)};
}

}  // namespace

BodyState FromMessage(const OdometryMessage& odometry) {
  BodyState body = AtPose(odometry.pose.pose);
  const TwistMessage& twist = odometry.twist.twist;
  body.linear_velocity_mps = body.orientation * ToVector(twist.linear);
  body.angular_velocity_radps = body.orientation * ToVector(twist.angular);
  return body;
}

WrenchMessage ToMessage(const Wrench& wrench) {
  return {ToVector3(wrench.force_n), ToVector3(wrench.torque_nm)};
}

PlanRequestMessage ToMessage(const PlanRequest& request) {
  return {request.id, ToMessage(request.predator), ToMessage(request.prey)};
}

PlanRequest FromMessage(const PlanRequestMessage& message) {
  return {.id = message.id,
          .predator = FromMessage(message.predator),
          .prey = FromMessage(message.prey)};
}

PlanToWrite::PlanToWrite(const PlanReply& reply) {
  for (const PlanStep& step : reply.steps) steps_.push_back(ToMessage(step));
  const auto count = static_cast<std::uint32_t>(steps_.size());
  message_ = {.id = reply.id,
              .planning_time = reply.planning_time_s,
              .states_explored = reply.states_explored,
              .reaches_goal = reply.reaches_goal,
              .duration = reply.plan_duration_s,
              .steps = {count, count, steps_.data(), /*_release=*/false}};
}

PlanReply FromMessage(const PlanMessage& message) {
  PlanReply reply{.id = message.id,
                  .planning_time_s = message.planning_time,
                  .states_explored = message.states_explored,
                  .reaches_goal = message.reaches_goal,
                  .plan_duration_s = message.duration};
  for (const auto& step : std::span(message.steps._buffer, message.steps._length)) {
    reply.steps.push_back(FromMessage(step));
  }
  return reply;
}

}  // namespace predator_prey
