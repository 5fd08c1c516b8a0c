// Commands that threads have sent through their command rings (shm/command_ring.h) instead of the
// kernel. They go to where the same datagrams would have come in, in the order in which they were
// sent, at the times that the program's clock showed.
//
// For the coordinator's thread only. Makes no system call but those of the world that takes them.
#pragma once

#include <string>

#include "coordinator/tasks/run_state.h"
#include "coordinator/world/world.h"

namespace tcs {

class PostedDatagrams {
 public:
  // Both outlive this.
  PostedDatagrams(RunState& run, World& world) : run_(run), world_(world) {}

  // Takes what the thread has posted, whose turn it is. Call this when it stops, before its virtual
  // CPU goes on; and before anything else that was sent to the world is taken. Null; or what of it
  // cannot be, as SlotCheck has it.
  const char* Take(Task& task);

 private:
  RunState& run_;
  World& world_;
  std::string datagram_;  // memory of Take
};

}  // namespace tcs
