#include "simbody_bridge/command_queue.h"

namespace tcs {

void CommandQueue::Add(VirtualTime t, const Command& command) { commands_.emplace(t, command); }

VirtualTime CommandQueue::NextTime() const {
  return commands_.empty() ? VirtualTime::Never() : commands_.begin()->first;
}

std::optional<Command> CommandQueue::TakeDue(VirtualTime now) {
  if (commands_.empty() || commands_.begin()->first > now) return std::nullopt;
  const Command command = commands_.begin()->second;
  commands_.erase(commands_.begin());
  return command;
}

}  // namespace tcs
