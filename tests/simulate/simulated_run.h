// The parts of the engine for one run, on a simulated host, and the threads of the run's programs
// there.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>

#include "coordinator/engine/wiring.h"
#include "libtcs_preload/guest.h"
#include "tests/simulate/kernel.h"

namespace tcs::simulate {

class SimulatedRun {
 public:
  // `host`: the seed of what the kernel does.
  SimulatedRun(Scenario scenario, std::uint64_t host, bool has_levels, bool is_fixed);

  // A process of that robot, whose first thread is the next one that is added. `client` outlives
  // it.
  Process& AddClient(Robot& robot, const ClientSpec& client);
  // A thread of the client that was added last. `body` gets what it attaches by, and must not
  // return.
  Task& AddThread(std::function<void(const preload::GuestThread&)> body);

  Kernel& kernel() { return kernel_; }
  const Kernel& kernel() const { return kernel_; }
  Wiring& all() { return all_; }
  const Wiring& all() const { return all_; }

 private:
  Kernel kernel_;
  Wiring all_;
  std::deque<SimProcess> processes_;
  Process* client_ = nullptr;
  pid_t next_pid_ = 1'000'000'000;
  int threads_ = 0;  // of that client
};

}  // namespace tcs::simulate
