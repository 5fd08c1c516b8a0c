// The metrics that a scenario names, evaluated while the world goes on: each metric at the virtual
// times 0, `every`, 2 `every`, ... from its `from` to its `until`, when no command for an earlier
// time can come any more. A command that acts, or a sample that is taken, at that very instant has
// not changed the state, but the sample counts among the values of its channel.
//
// Reading changes nothing of how bodies move. Not thread-safe.
#pragma once

#include <cstddef>
#include <deque>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "coordinator/channel/channel.h"
#include "coordinator/metrics/metric_book.h"
#include "coordinator/scenario/scenario.h"
#include "coordinator/world/command_log.h"
#include "simbody_bridge/dynamics.h"

namespace tcs {

class ScenarioMetrics {
 public:
  ScenarioMetrics() = default;
  ScenarioMetrics(const ScenarioMetrics&) = delete;
  ScenarioMetrics& operator=(const ScenarioMetrics&) = delete;

  // Called once, before all others. The scenario outlives this.
  void Open(const Scenario& scenario);
  // An outlet for the scenario's sensor of that number whose readings are heard here, if a metric
  // is of the sensor. This object outlives the outlet.
  std::unique_ptr<Outlet> Wrap(std::size_t sensor, std::unique_ptr<Outlet> outlet);
  // From now on values are taken; the book outlives this, which outlives the use of the log that
  // tells of commands.
  void WriteInto(MetricBook& book, CommandLog& commands);

  // When the next value is due; never while no book takes values.
  VirtualTime NextStop() const;
  // Takes the values that are due at dynamics.Now().
  void Evaluate(Dynamics& dynamics);

 private:
  class HeardOutlet;
  // A commanded value that acts from an instant on.
  struct Commanded {
    VirtualTime acts;
    double value;
  };
  struct Metric {
    const MetricSpec* spec;
    std::string_view from;  // kMetricFromScenario, or kMetricFromExpectations
    std::vector<std::size_t> needs;
    VirtualDuration every;
    VirtualTime next, next_line;
    int number = -1;  // in the book
  };
  void Hear(std::size_t sensor, const Reading& reading);
  void HearCommand(CommandLog::Moment moment, std::string_view channel, std::string_view target,
                   std::string_view quantity, double value);
  void Read(Dynamics& dynamics);
  void Take(Metric& metric, VirtualTime now);

  const Scenario* scenario_ = nullptr;
  MetricBook* book_ = nullptr;
  std::vector<Metric> metrics_;
  // The value of each quantity; not finite: the value is not known.
  std::vector<double> values_;
  std::vector<std::deque<Commanded>> commanded_;  // of each quantity: those that act later
  // The bodies, links and joints that are read of the dynamics at once, and their states.
  std::vector<int> bodies_, links_, joints_;
  std::vector<BodyState> body_states_;
  std::vector<LinkState> link_states_;
  std::vector<JointState> joint_states_;
  std::vector<std::size_t> place_of_;  // of each quantity, in the list of its kind
};

}  // namespace tcs
