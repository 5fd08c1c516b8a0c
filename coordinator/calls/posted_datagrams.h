// Commands that threads have sent through their command rings (shm/command_ring.h) instead of the
// kernel. The commands go to where the same datagrams would have come in, in the order in which
// they were sent, at the times that the program's clock showed.
//
// For the coordinator's thread only. Makes no system call but those of the world that takes them.
#pragma once

#include <string>

#include "coordinator/tasks/run_state.h"
#include "coordinator/world/world.h"

namespace tcs {

class PostedDatagrams {
 public:
  // `run` and `world` outlive this.
  PostedDatagrams(RunState& run, World& world) : run_(run), world_(world) {}

  // Takes the commands that the thread, whose turn it is, has posted. Call this when the thread
  // stops, before its virtual CPU goes on; and before anything else that was sent to the world is
  // taken. Null, or what in the commands is impossible, as in SlotCheck.
  const char* Take(Task& task);

 private:
  RunState& run_;
  World& world_;
  std::string datagram_;  // memory of Take
};

}  // namespace tcs
