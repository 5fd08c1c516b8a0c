#include "examples/predator_prey/predator_controller/plan_requester.h"

#include <cstdio>

namespace predator_prey {

PlanRequester::PlanRequester(const DdsEntity& participant, const std::string& name_space,
                             double timeout_s)
    : requests_(PlanRequestTopic(participant, name_space)),
      plans_(PlanTopic(participant, name_space)),
      timeout_s_(timeout_s) {}

void PlanRequester::RequestIfIdle(double time_s, const BodyState& predator, const BodyState& prey) {
  if (!requests_.IsMatched() || !plans_.IsMatched()) {
    outstanding_since_s_.reset();  // whoever was asked is gone: no use in waiting
    return;
  }
  if (outstanding_since_s_) {
    if (time_s - *outstanding_since_s_ < timeout_s_) return;
    std::fprintf(stderr, "predator_controller: no answer to plan request %llu, asking again\n",
                 static_cast<unsigned long long>(last_id_));
  }
  outstanding_since_s_ = time_s;
  requests_.Write(ToMessage(PlanRequest{.id = ++last_id_, .predator = predator, .prey = prey}));
}

std::optional<PlanReply> PlanRequester::TakeReply() {
  const Loan<PlanMessage> plan = plans_.TakeNewest();
  if (!plan || !outstanding_since_s_ || plan->id != last_id_) return std::nullopt;
  outstanding_since_s_.reset();
  return FromMessage(*plan);
}

}  // namespace predator_prey
