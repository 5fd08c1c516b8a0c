#include "coordinator/tasks/run_state.h"

#include "coordinator/os/host.h"

namespace tcs {

RunState::RunState(const Scenario& its_scenario, const RunOptions& its_options, bool only_gates,
                   bool with_porters)
    : scenario(its_scenario),
      options(its_options),
      gates_only(only_gates || with_porters),
      has_porters(with_porters),
      table([](pid_t pid) { return ThreadState(pid) != 'Z'; }),
      root(scenario.drift_bound.ns(), scenario.duration.ns()),
      end_ns(scenario.duration.ns()) {}

void RunState::Warn(const std::string& text) {
  if (std::ranges::find(report.warnings, text) != report.warnings.end()) return;
  report.warnings.push_back(text);
  if (options.on_warning) options.on_warning(text);
}

std::int64_t RunState::ChargeAsDebt(Task& task, std::int64_t ns) {
  task.charged_ns += ns;
  task.debt_ns += ns;
  const std::int64_t host_ns = task.metered.HostNs(ns);
  report.client_ns += host_ns;
  return host_ns;
}

std::int64_t RunState::WrittenAt() const {
  const Task& task = *turn.task();
  const std::int64_t start = task.cpu->progress_ns;
  if (task.slot < 0 || IsCallback()) return start;
  const std::int64_t shown = SlotOf(task).clock.last_shown_ns.load();
  return std::clamp(shown, start, std::max(start, turn.horizon_ns()));
}

}  // namespace tcs
