// What is done about what the kernel says, by the kind of descriptor that it says it at.
#pragma once

#include <cstdint>

#include "coordinator/engine/engine_part.h"
#include "coordinator/tasks/reactor.h"

namespace tcs {

class KernelEvents : public EnginePart {
 public:
  using EnginePart::EnginePart;

  // With the reactor.
  void Register();

 private:
  PollOutcome OnPipe(Subject process, std::uint32_t events, Moment moment);
  PollOutcome OnListener(Subject listener, std::uint32_t events, Moment moment);
  PollOutcome OnConnection(Subject subject, std::uint32_t events, Moment moment);
  PollOutcome OnProcessEnd(Subject process, std::uint32_t events, Moment moment);
  PollOutcome OnAwaited(Subject subject, std::uint32_t events, Moment moment);
  PollOutcome OnOutside(Subject file, std::uint32_t events, Moment moment);
  PollOutcome OnUnknownChildEnd(Subject child, std::uint32_t events, Moment moment);
  PollOutcome OnTrap(Subject subject, std::uint32_t events, Moment moment);
  PollOutcome OnCommand(Subject channel, std::uint32_t events, Moment moment);
  PollOutcome OnNetwork(Subject robot, std::uint32_t events, Moment moment);
  PollOutcome OnSignal(Subject subject, std::uint32_t events, Moment moment);
  PollOutcome OnGraceRanOut(Subject subject, std::uint32_t events, Moment moment);
  PollOutcome OnDetector(Subject subject, std::uint32_t events, Moment moment);
  PollOutcome OnDetectorEnd(Subject subject, std::uint32_t events, Moment moment);
  PollOutcome OnStateAsked(Subject subject, std::uint32_t events, Moment moment);
};

}  // namespace tcs
