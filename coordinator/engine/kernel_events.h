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
  Reactor::Found OnPipe(Subject process, std::uint32_t events, Moment moment);
  Reactor::Found OnListener(Subject listener, std::uint32_t events, Moment moment);
  Reactor::Found OnConnection(Subject subject, std::uint32_t events, Moment moment);
  Reactor::Found OnProcessEnd(Subject process, std::uint32_t events, Moment moment);
  Reactor::Found OnAwaited(Subject subject, std::uint32_t events, Moment moment);
  Reactor::Found OnOutside(Subject file, std::uint32_t events, Moment moment);
  Reactor::Found OnUnknownChildEnd(Subject child, std::uint32_t events, Moment moment);
  Reactor::Found OnTrap(Subject subject, std::uint32_t events, Moment moment);
  Reactor::Found OnCommand(Subject channel, std::uint32_t events, Moment moment);
  Reactor::Found OnNetwork(Subject robot, std::uint32_t events, Moment moment);
  Reactor::Found OnSignal(Subject subject, std::uint32_t events, Moment moment);
  Reactor::Found OnGraceRanOut(Subject subject, std::uint32_t events, Moment moment);
  Reactor::Found OnDetector(Subject subject, std::uint32_t events, Moment moment);
  Reactor::Found OnDetectorEnd(Subject subject, std::uint32_t events, Moment moment);
  Reactor::Found OnStateAsked(Subject subject, std::uint32_t events, Moment moment);
};

}  // namespace tcs
