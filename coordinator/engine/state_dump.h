// The whole state of a run, as `tcsim dump` asks for it: where each part is in virtual time, what
// each thread does or waits for, and on whom; which queues there are, and which threads are in
// them.
//
// For the coordinator's thread only. Changes nothing and looks at no other process: some
// microseconds for each thread. The asker adds what the kernel knows of threads (dump/kernel.h).
#pragma once

#include <cstdint>
#include <string>

#include "coordinator/dds/hub.h"
#include "coordinator/dump/state_link.h"
#include "coordinator/engine/computing_ahead.h"
#include "coordinator/engine/pacing.h"
#include "coordinator/host/host_cpu.h"
#include "coordinator/network/robot_network.h"
#include "coordinator/processes/launches.h"
#include "coordinator/processes/unregistered_children.h"
#include "coordinator/queues/futex_table.h"
#include "coordinator/queues/wait_queues.h"
#include "coordinator/tasks/run_clock.h"
#include "coordinator/tasks/run_state.h"
#include "coordinator/world/world.h"

namespace tcs {

class StateDump {
 public:
  // The objects that the dump reads, which outlive it.
  struct Sources {
    const RunState& run;
    const RunClock& clock;
    const HostCpu& host_cpu;
    const World& world;
    const RobotNetwork& network;
    const Launches& launches;
    const ComputingAhead& ahead;
    const FutexTable& futexes;
    const WaitQueues& objects;
    const dds::Hub& hub;
    const UnregisteredChildren& unregistered_children;
    const Pacing& pacing;
    const StateLink& link;
  };

  explicit StateDump(const Sources& from) : from_(from) {}

  // JSON, as docs/DEBUGGING.md describes it. The threads take turns on processor `host_cpu`; the
  // current TSC is `now_tsc`.
  [[nodiscard]] std::string Text(int host_cpu, std::uint64_t now_tsc) const;

 private:
  const Sources from_;
};

}  // namespace tcs
