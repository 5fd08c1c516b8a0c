// The handlers of what the kernel says, by the kind of descriptor at which the kernel says it.
#pragma once

#include <cstdint>

#include "coordinator/engine/engine_part.h"
#include "coordinator/tasks/reactor.h"

namespace tcs {

class KernelEvents : public EnginePart {
 public:
  using EnginePart::EnginePart;

  // Registers the handlers with the reactor.
  void Register();

 private:
  PollOutcome OnPipe(Subject process, std::uint32_t events, EventTime when);
  PollOutcome OnListener(Subject listener, std::uint32_t events, EventTime when);
  PollOutcome OnConnection(Subject subject, std::uint32_t events, EventTime when);
  PollOutcome OnProcessEnd(Subject process, std::uint32_t events, EventTime when);
  PollOutcome OnAwaited(Subject subject, std::uint32_t events, EventTime when);
  PollOutcome OnOutside(Subject file, std::uint32_t events, EventTime when);
  PollOutcome OnUnregisteredChildEnd(Subject child, std::uint32_t events, EventTime when);
  PollOutcome OnTrap(Subject subject, std::uint32_t events, EventTime when);
  PollOutcome OnCommand(Subject channel, std::uint32_t events, EventTime when);
  PollOutcome OnNetwork(Subject robot, std::uint32_t events, EventTime when);
  PollOutcome OnSignal(Subject subject, std::uint32_t events, EventTime when);
  PollOutcome OnGraceRanOut(Subject subject, std::uint32_t events, EventTime when);
  PollOutcome OnDetector(Subject subject, std::uint32_t events, EventTime when);
  PollOutcome OnDetectorEnd(Subject subject, std::uint32_t events, EventTime when);
  PollOutcome OnStateAsked(Subject subject, std::uint32_t events, EventTime when);
};

}  // namespace tcs
