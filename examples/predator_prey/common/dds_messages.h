// The messages of the predator's topics, and what they mean.
//
// A DDS type is checked by DDS, so whatever comes has the right fields.
#pragma once

#include <vector>

#include "examples/predator_prey/common/plan.h"
#include "geometry_msgs.h"
#include "nav_msgs.h"
#include "predator_prey_msgs.h"

namespace predator_prey {

using OdometryMessage = nav_msgs_msg_dds__Odometry_;
using WrenchMessage = geometry_msgs_msg_dds__Wrench_;
using PlanRequestMessage = predator_prey_msgs_msg_dds__PlanRequest_;
using PlanMessage = predator_prey_msgs_msg_dds__Plan_;

// Odometry tells the twist in the body's frame.
BodyState FromMessage(const OdometryMessage& odometry);

WrenchMessage ToMessage(const Wrench& wrench);

PlanRequestMessage ToMessage(const PlanRequest& request);
PlanRequest FromMessage(const PlanRequestMessage& message);

// A plan with the memory of its steps.
class PlanToWrite {
 public:
  explicit PlanToWrite(const PlanReply& reply);
  PlanToWrite(const PlanToWrite&) = delete;

  const PlanMessage& message() const { return message_; }

 private:
  std::vector<predator_prey_msgs_msg_dds__PlanStep_> steps_;
  PlanMessage message_;
};

PlanReply FromMessage(const PlanMessage& message);

}  // namespace predator_prey
