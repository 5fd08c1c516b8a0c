// The controller's side of the conversation with the planner: one request outstanding at most,
// asked again when the answer does not come. Any datagram may be lost, late or foreign.
#pragma once

#include <cstdint>
#include <optional>

#include "examples/predator_prey/common/messages.h"
#include "examples/predator_prey/common/udp_socket.h"

namespace predator_prey {

// `time_s` is the caller's clock, the same in all calls.
class PlanRequester {
 public:
  PlanRequester(std::uint16_t planner_port, double timeout_s);

  // Readable when TakeReply() has something to do.
  int fd() const { return socket_.fd(); }

  // Asks for a plan from the state just read, unless an answer is still awaited.
  void RequestIfIdle(double time_s, const SensorReading& seen);

  // The answer to the outstanding request, if it has come. Answers to older requests are dropped.
  std::optional<PlanReply> TakeReply();

 private:
  UdpSocket socket_;
  double timeout_s_;
  std::uint64_t last_id_ = 0;
  std::optional<double> outstanding_since_s_;
};

}  // namespace predator_prey
