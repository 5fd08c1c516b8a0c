#include "coordinator/tasks/run_state.h"

#include <algorithm>

#include "coordinator/port/proc_files.h"

namespace tcs {

RunState::RunState(const Scenario& its_scenario, const RunOptions& its_options, bool unprivileged,
                   bool with_brokers)
    : scenario(its_scenario),
      options(its_options),
      is_unprivileged(unprivileged || with_brokers),
      has_brokers(with_brokers),
      table([](pid_t pid) { return ThreadState(pid) != 'Z'; }),
      root(scenario.drift_bound, VirtualTime() + scenario.duration),
      end(VirtualTime() + scenario.duration) {}

void RunState::Warn(const std::string& text) {
  if (std::ranges::find(report.warnings, text) != report.warnings.end()) return;
  report.warnings.push_back(text);
  if (options.on_warning) options.on_warning(text);
}

HostDuration RunState::ChargeAsDebt(Task& task, VirtualDuration computed) {
  task.charged += computed;
  task.debt += computed;
  if (task.cpu != nullptr) task.cpu->busy += computed;
  const HostDuration host = task.metered.OnHost(computed);
  report.client_ns += host.ns();
  return host;
}

// The thread's CPU clock does not have what is charged here: the charge's origin on it moves.
void RunState::ChargePrice(Task& task, VirtualDuration price) {
  task.charged += price;
  task.priced += price;
  task.debt += price;
  if (task.cpu != nullptr) task.cpu->busy += price;
  if (task.metered.has_origin()) task.metered.host_origin_ns -= task.metered.OnHost(price).ns();
}

VirtualTime RunState::WrittenAt() const {
  const Task& task = *turn.task();
  if (task.slot < 0) return task.cpu->progress;
  return WrittenAt(OwnTime(SlotOf(task).clock.last_shown_ns.load()));
}

VirtualTime RunState::WrittenAt(ProgramTime shown) const {
  const VirtualTime start = turn.task()->cpu->progress;
  if (IsCallback()) return start;
  // Programs have no clocks of their own here.
  return std::clamp(RobotTime(shown.ns()), start, std::max(start, turn.horizon()));
}

}  // namespace tcs
