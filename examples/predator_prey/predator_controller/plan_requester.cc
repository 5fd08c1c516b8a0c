#include "examples/predator_prey/predator_controller/plan_requester.h"

#include <cstdio>
#include <string>

namespace predator_prey {

PlanRequester::PlanRequester(std::uint16_t planner_port, double timeout_s)
    : socket_(UdpSocket::ConnectedTo(planner_port)), timeout_s_(timeout_s) {}

void PlanRequester::RequestIfIdle(double time_s, const SensorReading& seen) {
  if (outstanding_since_s_) {
    if (time_s - *outstanding_since_s_ < timeout_s_) return;
    std::fprintf(stderr, "predator_controller: no answer to plan request %llu, asking again\n",
                 static_cast<unsigned long long>(last_id_));
  }
  outstanding_since_s_ = time_s;
  socket_.Send(Encode(PlanRequest{.id = ++last_id_, .predator = seen.predator, .prey = seen.prey}));
}

std::optional<PlanReply> PlanRequester::TakeReply() {
  std::string datagram;
  for (;;) {
    switch (socket_.Receive(datagram)) {
      case UdpSocket::Status::kNothing:
        return std::nullopt;
      case UdpSocket::Status::kPeerAbsent:  // the planner is still starting: no use in waiting
        outstanding_since_s_.reset();
        break;
      case UdpSocket::Status::kDatagram:
        if (auto reply = DecodePlanReply(datagram);
            outstanding_since_s_ && reply && reply->id == last_id_) {
          outstanding_since_s_.reset();
          return reply;
        }
        break;
    }
  }
}

}  // namespace predator_prey
