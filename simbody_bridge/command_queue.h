// The wrenches that are still to be applied, in the order in which they take effect: by time, and
// in the order they were given where times are equal. A plain value: a checkpoint holds a copy.
#pragma once

#include <map>
#include <optional>

#include "shm/virtual_time.h"
#include "simbody_bridge/dynamics.h"

namespace tcs {

struct Command {
  int body = 0;  // index into WorldSpec::bodies
  Wrench wrench;
};

class CommandQueue {
 public:
  void Add(VirtualTime t, const Command& command);

  // When the first command takes effect; Never() if there is none.
  VirtualTime NextTime() const;

  // Removes and returns the first command if it takes effect at `now` or before.
  std::optional<Command> TakeDue(VirtualTime now);

 private:
  std::multimap<VirtualTime, Command> commands_;  // keeps the order of insertion among equal times
};

}  // namespace tcs
