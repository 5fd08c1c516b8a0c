// The robots' channels on DDS: sensors, the clock, commands (docs/SCENARIO.md). What the dynamics
// send and take there, as the coordinator's own endpoints.
//
// Times are virtual nanoseconds since the run's start; stamps are virtual CLOCK_REALTIME.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "coordinator/core/command_input.h"
#include "coordinator/core/ros_nodes.h"
#include "coordinator/dds/own_endpoints.h"
#include "coordinator/dds/robot_topics.h"
#include "coordinator/scenario/scenario.h"

namespace tcs {

class DdsChannels {
 public:
  // Announces the scenario's channels. The endpoints and the scenario outlive this.
  // `input` hears what comes in on the channels of commands.
  DdsChannels(const Scenario& scenario, dds::OwnEndpoints& ends, std::int64_t realtime_offset_ns,
              CommandInput& input);

  // When the dynamics have to be looked at next, and when something next leaves them.
  std::int64_t NextSampleNs() const;
  std::int64_t NextOutputNs() const;

  // Adds the bodies of all samples that are due at `now_ns`.
  void AddDueBodies(std::int64_t now_ns, std::vector<int>* bodies) const;
  // Writes what is due at `now_ns`; `read` says how a body is. Returns how many samples there were.
  int WriteDue(std::int64_t now_ns, const std::function<BodyState(int body)>& read);

  struct Command {
    std::int64_t at_ns;  // when it acts
    int body;
    Wrench wrench;
  };
  // The commands of the next sample that was written by `now_ns`; none: there is no such sample.
  // A sample that cannot be read yields no commands.
  std::optional<std::vector<Command>> TakeCommands(std::int64_t now_ns);

 private:
  struct Sensor {
    const DdsSensorSpec* spec;
    dds::OwnEndpoints::Index writer;
    dds::SensorEncoder encoder;
    std::int64_t next_ns = 0;
  };
  struct Actuator {
    const DdsCommandSpec* spec;
    dds::OwnEndpoints::Index reader;
  };

  dds::OwnEndpoints::Index Add(dds::EndpointKind kind, const DdsTopicSpec& end,
                               std::string_view message, std::optional<int> body);
  void Decode(const Actuator& actuator, const dds::OwnEndpoints::Sample& sample,
              std::vector<Command>* commands);

  const Scenario& scenario_;
  dds::OwnEndpoints& ends_;
  CommandInput& input_;
  RosNodes nodes_;
  std::int64_t realtime_offset_ns_;
  std::vector<Sensor> sensors_;
  std::vector<Actuator> actuators_;
  std::optional<dds::OwnEndpoints::Index> clock_;
  std::int64_t next_clock_ns_;
};

}  // namespace tcs
