#include "coordinator/channel/dds/dds_channels.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <variant>

#include "coordinator/dds/measurement_messages.h"
#include "coordinator/dds/robot_topics.h"
#include "coordinator/dds/type_hash.h"

namespace tcs {

namespace {

dds::BodyVariances VariancesOf(const SensorErrors& errors) {
  const auto of = [&errors](SensorField field) {
    return errors.fields[static_cast<std::size_t>(field)].Variance();
  };
  return {.position = of(SensorField::kPosition),
          .orientation = of(SensorField::kOrientation),
          .linear_velocity = of(SensorField::kLinearVelocity),
          .angular_velocity = of(SensorField::kAngularVelocity),
          .angular_rate = of(SensorField::kAngularRate),
          .proper_acceleration = of(SensorField::kProperAcceleration)};
}

}  // namespace

// No reading stays here: the hub has it.
class DdsChannels::SensorOutlet final : public Outlet {
 public:
  // The encoder is of a sensor of bodies.
  SensorOutlet(DdsChannels& transport, const SensorChannelSpec& spec,
               std::optional<dds::SensorEncoder> encoder)
      : transport_(transport), spec_(spec), encoder_(std::move(encoder)) {}

  void Begin() {
    const auto& to = std::get<DdsSensorEnd>(spec_.to);
    const auto body = spec_.bodies.empty() ? std::nullopt : std::optional(spec_.bodies.front());
    writer_ = transport_.Add(dds::EndpointKind::kWriter, to.end, dds::NameOf(to.message), body);
  }

  bool Send(const Reading& reading, VirtualTime arrives) override {
    const std::int64_t stamp_ns = transport_.StampOf(reading.at);
    transport_.ends_.Write(writer_, Encoded(reading, stamp_ns), stamp_ns, arrives.ns());
    return true;
  }
  VirtualTime NextDue() const override { return VirtualTime::Never(); }
  bool HandOver(VirtualTime) override { return false; }

 private:
  std::vector<std::byte> Encoded(const Reading& reading, std::int64_t stamp_ns) const {
    if (spec_.instrument) {
      return dds::EncodeMeasurement(stamp_ns, reading.measured, transport_.scenario_.ros);
    }
    if (spec_.joints) {
      std::vector<JointState> states;
      for (const JointReading& joint : reading.joints) states.push_back(joint.state);
      return dds::EncodeJoints(stamp_ns, spec_.joints->names, states);
    }
    std::vector<BodyState> states;
    for (const BodyReading& body : reading.bodies) states.push_back(body.state);
    return encoder_->Encode(stamp_ns, states, reading.bodies.front().felt);
  }

  DdsChannels& transport_;
  const SensorChannelSpec& spec_;
  std::optional<dds::SensorEncoder> encoder_;
  dds::OwnEndpoints::Index writer_ = 0;
};

class DdsChannels::ClockOutlet final : public Outlet {
 public:
  explicit ClockOutlet(DdsChannels& transport) : transport_(transport) {}

  bool Send(const Reading& reading, VirtualTime arrives) override {
    const std::int64_t stamp_ns = transport_.StampOf(reading.at);
    transport_.ends_.Write(*transport_.clock_, dds::EncodeClock(stamp_ns), stamp_ns, arrives.ns());
    return true;
  }
  VirtualTime NextDue() const override { return VirtualTime::Never(); }
  bool HandOver(VirtualTime) override { return false; }

 private:
  DdsChannels& transport_;
};

class DdsChannels::CommandInlet final : public Inlet {
 public:
  explicit CommandInlet(DdsChannels& transport) : transport_(transport) {}

  int fd() const override { return -1; }

  void Receive(const CommandSent& now, CommandSink& sink) override {
    while (const auto sample = transport_.ends_.Take(now.at.ns())) {
      for (const Actuator& actuator : transport_.actuators_) {
        const auto& readers = sample->readers;
        if (std::find(readers.begin(), readers.end(), actuator.reader) == readers.end()) continue;
        Decode(actuator, *sample, transport_.realtime_offset_, sink);
      }
    }
  }

  Place PlaceOf(std::size_t channel) const override {
    const auto& from = std::get<DdsCommandEnd>(transport_.scenario_.commands[channel].from);
    return {"on " + from.end.topic, fmt::format("write {} there", dds::NameOf(from.message))};
  }

 private:
  static void Decode(const Actuator& actuator, const dds::OwnEndpoints::Sample& sample,
                     VirtualDuration realtime_offset, CommandSink& sink) {
    const auto give = [&](const auto& decoded) {
      if (const auto* error = std::get_if<dds::MessageError>(&decoded)) {
        sink.Refuse(actuator.channel,
                    fmt::format("a sample on {} {}", actuator.end->end.topic, error->message));
      } else {
        sink.Take(
            actuator.channel,
            {VirtualTime::FromNanoseconds(sample.at_ns), {sample.writer, sample.sender_ran_ns}},
            std::get<0>(decoded));
      }
    };
    const dds::CommandMessage message = actuator.end->message;
    const std::optional<GoalNames> goals = sink.GoalsOf(actuator.channel);
    if (goals && goals->are_wheels) {
      give(dds::DecodeSpeed(sample.cdr));
    } else if (goals && goals->follow_trajectories) {
      give(dds::DecodeTrajectory(goals->names, realtime_offset, sample.cdr));
    } else if (goals) {
      // Numbers without names are of the joints or rotors that are driven.
      const bool has_names = message != dds::CommandMessage::kFloat64MultiArray;
      give(dds::DecodeJointCommand(message, has_names ? goals->names : goals->Driven(),
                                   goals->quantity, sample.cdr));
    } else {
      give(dds::DecodeCommand(message, sample.cdr));
    }
  }

  DdsChannels& transport_;
};

std::unique_ptr<DdsChannels> DdsChannels::For(const Scenario& scenario, dds::OwnEndpoints& ends) {
  const auto is_ours = [](const SensorChannelSpec& spec) {
    return std::holds_alternative<DdsSensorEnd>(spec.to);
  };
  const auto commands_us = [](const CommandChannelSpec& spec) {
    return std::holds_alternative<DdsCommandEnd>(spec.from);
  };
  if (!scenario.clock.has_value() &&
      std::none_of(scenario.sensors.begin(), scenario.sensors.end(), is_ours) &&
      std::none_of(scenario.commands.begin(), scenario.commands.end(), commands_us)) {
    return nullptr;
  }
  return std::unique_ptr<DdsChannels>(new DdsChannels(scenario, ends));
}

std::unique_ptr<Outlet> DdsChannels::OutletOf(const SensorChannelSpec& spec) {
  std::vector<std::string> bodies;
  for (const int body : spec.bodies) {
    bodies.push_back(scenario_.world->bodies[static_cast<std::size_t>(body)].name);
  }
  std::optional<dds::SensorEncoder> encoder;
  if (!bodies.empty()) {
    encoder.emplace(std::get<DdsSensorEnd>(spec.to).message, std::move(bodies),
                    VariancesOf(spec.errors));
  }
  auto outlet = std::make_unique<SensorOutlet>(*this, spec, std::move(encoder));
  sensors_.push_back(outlet.get());
  return outlet;
}

std::unique_ptr<Outlet> DdsChannels::Clock() {
  if (!scenario_.clock.has_value()) return nullptr;
  return std::make_unique<ClockOutlet>(*this);
}

std::unique_ptr<Inlet> DdsChannels::Commands() { return std::make_unique<CommandInlet>(*this); }

void DdsChannels::Begin(VirtualDuration realtime_offset) {
  realtime_offset_ = realtime_offset;
  for (SensorOutlet* sensor : sensors_) sensor->Begin();
  for (std::size_t i = 0; i < scenario_.commands.size(); ++i) {
    const CommandChannelSpec& spec = scenario_.commands[i];
    const auto* from = std::get_if<DdsCommandEnd>(&spec.from);
    if (from == nullptr) continue;
    actuators_.push_back({i, from,
                          Add(dds::EndpointKind::kReader, from->end, dds::NameOf(from->message),
                              spec.IsOfModel() ? std::nullopt : std::optional(spec.body))});
  }
  if (scenario_.clock.has_value()) {
    clock_ = Add(dds::EndpointKind::kWriter, scenario_.clock->end, dds::kClockMessageName, {});
  }
  nodes_.Announce(ends_, realtime_offset.ns());
}

dds::OwnEndpoints::Index DdsChannels::Add(dds::EndpointKind kind, const DdsTopicSpec& end,
                                          std::string_view message, std::optional<int> body) {
  const dds::Endpoint endpoint{.kind = kind,
                               .topic = dds::DdsTopic(end.topic),
                               .type = dds::DdsType(message),
                               .keyless = true,
                               .qos = end.qos,
                               .user_data = dds::UserDataOf(message, scenario_.ros)};
  const dds::OwnEndpoints::Index index = ends_.Add(endpoint, end.domain, 0);
  nodes_.Add(ends_, index, kind, end.domain, body);
  return index;
}

}  // namespace tcs
