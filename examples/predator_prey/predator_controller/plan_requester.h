// The controller's side of the conversation with the planner: one request outstanding at most,
// asked again when the answer does not come. A planner may start late, end and come back.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "examples/predator_prey/common/predator_topics.h"

namespace predator_prey {

// `time_s` is the caller's clock, the same in all calls.
class PlanRequester {
 public:
  PlanRequester(const DdsEntity& participant, const std::string& name_space, double timeout_s);

  // Triggered when TakeReply() has something to do.
  const DdsEntity& has_plan() const { return plans_.has_samples(); }

  // Asks for a plan from the states just read, unless an answer is still awaited or there is no
  // planner.
  void RequestIfIdle(double time_s, const BodyState& predator, const BodyState& prey);

  // The answer to the outstanding request, if it has come. Answers to older requests are dropped.
  std::optional<PlanReply> TakeReply();

 private:
  Writer<PlanRequestMessage> requests_;
  Reader<PlanMessage> plans_;
  double timeout_s_;
  std::uint64_t last_id_ = 0;
  std::optional<double> outstanding_since_s_;
};

}  // namespace predator_prey
