#include "coordinator/core/dds_channels.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "shm/layout.h"

namespace tcs {

DdsChannels::DdsChannels(const Scenario& scenario, dds::OwnEndpoints& ends,
                         std::int64_t realtime_offset_ns, CommandInput& input)
    : scenario_(scenario),
      ends_(ends),
      input_(input),
      nodes_(scenario),
      realtime_offset_ns_(realtime_offset_ns),
      next_clock_ns_(scenario.clock.has_value() ? 0 : shm::kNeverNs) {
  for (const DdsSensorSpec& spec : scenario.dds_sensors) {
    std::vector<std::string> bodies;
    for (const int body : spec.bodies) {
      bodies.push_back(scenario.world->bodies[static_cast<std::size_t>(body)].name);
    }
    const auto writer =
        Add(dds::EndpointKind::kWriter, spec.end, dds::NameOf(spec.message), spec.bodies.front());
    dds::SensorEncoder encoder(spec.message, std::move(bodies), scenario.world->gravity_mps2);
    sensors_.push_back({&spec, writer, std::move(encoder)});
  }
  for (const DdsCommandSpec& spec : scenario.dds_commands) {
    actuators_.push_back(
        {&spec, Add(dds::EndpointKind::kReader, spec.end, dds::NameOf(spec.message), spec.body)});
  }
  if (scenario.clock.has_value()) {
    clock_ = Add(dds::EndpointKind::kWriter, scenario.clock->end, dds::kClockMessageName, {});
  }
  nodes_.Announce(ends_, realtime_offset_ns_);
}

dds::OwnEndpoints::Index DdsChannels::Add(dds::EndpointKind kind, const DdsTopicSpec& end,
                                          std::string_view message, std::optional<int> body) {
  const dds::Endpoint endpoint{.kind = kind,
                               .topic = dds::DdsTopic(end.topic),
                               .type = dds::DdsType(message),
                               .keyless = true,
                               .qos = end.qos};
  const dds::OwnEndpoints::Index index = ends_.Add(endpoint, end.domain, 0);
  nodes_.Add(ends_, index, kind, end.domain, body);
  return index;
}

std::int64_t DdsChannels::NextSampleNs() const {
  std::int64_t next = next_clock_ns_;
  for (const Sensor& sensor : sensors_) next = std::min(next, sensor.next_ns);
  return next;
}

std::int64_t DdsChannels::NextOutputNs() const {
  std::int64_t next = next_clock_ns_;
  for (const Sensor& sensor : sensors_) {
    next = std::min(next, sensor.next_ns + sensor.spec->latency.ns());
  }
  return next;
}

void DdsChannels::AddDueBodies(std::int64_t now_ns, std::vector<int>* bodies) const {
  for (const Sensor& sensor : sensors_) {
    if (sensor.next_ns > now_ns) continue;
    bodies->insert(bodies->end(), sensor.spec->bodies.begin(), sensor.spec->bodies.end());
  }
}

int DdsChannels::WriteDue(std::int64_t now_ns, const std::function<BodyState(int body)>& read) {
  int written = 0;
  const std::int64_t stamp_ns = now_ns + realtime_offset_ns_;
  if (next_clock_ns_ <= now_ns) {
    next_clock_ns_ += scenario_.clock->period.ns();
    ends_.Write(*clock_, dds::EncodeClock(stamp_ns), stamp_ns, now_ns);
    ++written;
  }
  for (Sensor& sensor : sensors_) {
    if (sensor.next_ns > now_ns) continue;
    sensor.next_ns += sensor.spec->period.ns();
    std::vector<BodyState> states;
    for (const int body : sensor.spec->bodies) states.push_back(read(body));
    const auto cdr = sensor.encoder.Encode(VirtualTime::FromNanoseconds(now_ns), stamp_ns, states);
    ends_.Write(sensor.writer, cdr, stamp_ns, now_ns + sensor.spec->latency.ns());
    ++written;
  }
  return written;
}

std::optional<std::vector<DdsChannels::Command>> DdsChannels::TakeCommands(std::int64_t now_ns) {
  const auto sample = ends_.Take(now_ns);
  if (!sample.has_value()) return std::nullopt;
  std::vector<Command> commands;
  for (const Actuator& actuator : actuators_) {
    if (std::find(sample->readers.begin(), sample->readers.end(), actuator.reader) !=
        sample->readers.end()) {
      Decode(actuator, *sample, &commands);
    }
  }
  return commands;
}

void DdsChannels::Decode(const Actuator& actuator, const dds::OwnEndpoints::Sample& sample,
                         std::vector<Command>* commands) {
  const DdsCommandSpec& spec = *actuator.spec;
  const auto wrench = dds::DecodeCommand(spec.message, sample.cdr);
  if (const auto* error = std::get_if<dds::MessageError>(&wrench)) {
    input_.Refused(spec.name, fmt::format("a sample on {} {}", spec.end.topic, error->message));
    return;
  }
  input_.Took(spec.name);
  commands->push_back({sample.at_ns + spec.latency.ns(), spec.body, std::get<Wrench>(wrench)});
}

}  // namespace tcs
