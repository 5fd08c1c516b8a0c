#include "coordinator/engine/wiring.h"

#include "coordinator/host/fifo_executor.h"
#include "coordinator/host/gate_executor.h"
#include "coordinator/os/real_time_facts.h"
#include "coordinator/port/pidfds.h"
#include "coordinator/scenario/patience.h"

namespace tcs {

namespace {

std::unique_ptr<Executor> MakeExecutor(bool is_unprivileged) {
  if (is_unprivileged) return std::make_unique<GateExecutor>();
  return std::make_unique<FifoExecutor>();
}

}  // namespace

HostPermits AskHost() {
  return {.real_time = AskForRealTime(), .duplicates = WhyNoDuplicates() == 0};
}

Wiring::Wiring(const Scenario& scenario, const RunOptions& options, const HostPermits& permits)
    : real_time(permits.real_time),
      run(scenario, options, real_time.error != 0, !permits.duplicates),
      activations(run.IsCallback()),
      executor(MakeExecutor(run.is_unprivileged)),
      host_cpu(*executor, PatienceOf(scenario).ideal) {}

Wiring::~Wiring() = default;

}  // namespace tcs
