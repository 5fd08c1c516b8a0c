#include "coordinator/cli/stop_at.h"

#include <fmt/format.h>

#include "coordinator/scenario/duration.h"

namespace tcs {

namespace {

std::string TimeText(VirtualDuration time) { return SecondsText(time.ns()); }

}  // namespace

// "DIR@12.5s"; the folder may have an @, too.
std::pair<std::string, std::string> FolderAndTime(const std::string& from) {
  const std::size_t at = from.rfind('@');
  if (at == std::string::npos) return {from, ""};
  return {from.substr(0, at), from.substr(at + 1)};
}

std::string WhyNoStopAt(const Scenario& scenario, VirtualDuration duration,
                        VirtualDuration stop_at) {
  if (!scenario.world) {
    return "--stop-at: the scenario has no world to write a snapshot of; use --duration";
  }
  if (stop_at > duration) {
    return fmt::format("--stop-at: {} is after the end, {}; --duration sets a later one",
                       TimeText(stop_at), TimeText(duration));
  }
  const std::int64_t period_ns = scenario.csv_period.ns(), rest_ns = stop_at.ns() % period_ns;
  if (rest_ns == 0) return {};
  return fmt::format(
      "--stop-at: the world is written every {} (csv_period), at {} and at {}, but not at {}; take "
      "one of these, or another period",
      TimeText(scenario.csv_period), TimeText(VirtualDuration::Nanoseconds(stop_at.ns() - rest_ns)),
      TimeText(VirtualDuration::Nanoseconds(stop_at.ns() - rest_ns + period_ns)),
      TimeText(stop_at));
}

std::string NoWayBack(const std::string& from) {
  const auto [folder, time] = FolderAndTime(from);
  return fmt::format(
      "--from {}: programs cannot go back to a moment, because their memory is not recorded; "
      "`tcsim snapshot {} --out world.yaml` writes the world of that moment, from which `tcsim run "
      "SCENARIO --overlay world.yaml` begins with programs that start anew",
      from, from);
}

}  // namespace tcs
