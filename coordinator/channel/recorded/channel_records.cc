#include "coordinator/channel/recorded/channel_records.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>
#include <variant>

#include "coordinator/channel/forwarding_outlet.h"
#include "coordinator/dds/command_messages.h"
#include "coordinator/dds/measurement_messages.h"
#include "coordinator/dds/robot_topics.h"
#include "coordinator/dds/ros_messages.h"
#include "coordinator/dds/ros_names.h"

namespace tcs {
namespace {

std::string TopicOf(const std::string& channel) { return "/channels/" + dds::RosToken(channel); }

bool Has(const SensorChannelSpec& spec, SensorField field) {
  return std::ranges::find(spec.fields, field) != spec.fields.end();
}

// The body's state as the channel carries it.
BodyState Carried(const SensorChannelSpec& spec, BodyState state) {
  const auto keep = [&spec](SensorField field, auto* numbers) {
    if (!Has(spec, field)) numbers->fill(std::numeric_limits<double>::quiet_NaN());
  };
  keep(SensorField::kPosition, &state.position_m);
  keep(SensorField::kLinearVelocity, &state.linear_velocity_mps);
  keep(SensorField::kAngularVelocity, &state.angular_velocity_radps);
  return state;
}

}  // namespace

void ChannelRecords::Write(Topic* topic, const std::string& name, std::string_view type,
                           VirtualTime at, std::span<const std::byte> cdr) {
  if (topic->number < 0) topic->number = sink_->AddOwnTopic(name, type);
  sink_->WriteOwn(topic->number, at, cdr);
}

class ChannelRecords::WrappedOutlet final : public ForwardingOutlet {
 public:
  WrappedOutlet(ChannelRecords& records, const SensorChannelSpec& spec,
                std::unique_ptr<Outlet> outlet)
      : ForwardingOutlet(std::move(outlet)),
        records_(records),
        spec_(spec),
        states_(std::max<std::size_t>(1, spec.bodies.size())),
        felt_(states_.size()) {}

  bool Send(const Reading& reading, VirtualTime arrives) override {
    if (records_.sink_ != nullptr) Record(reading, arrives);
    return ForwardingOutlet::Send(reading, arrives);
  }

 private:
  void Record(const Reading& reading, VirtualTime arrives) {
    const std::int64_t stamp_ns = records_.sink_->StampOf(reading.at);
    const std::string name = TopicOf(spec_.name);
    if (spec_.instrument) {
      records_.Write(&states_[0], name, dds::NameOf(dds::MessageOf(reading.measured)), arrives,
                     dds::EncodeMeasurement(stamp_ns, reading.measured, records_.scenario_.ros));
      return;
    }
    if (spec_.joints) {
      std::vector<JointState> states;
      for (const JointReading& joint : reading.joints) states.push_back(joint.state);
      records_.Write(&states_[0], name, dds::NameOf(dds::SensorMessage::kJointState), arrives,
                     dds::EncodeJoints(stamp_ns, spec_.joints->names, states));
      return;
    }
    for (std::size_t i = 0; i < reading.bodies.size(); ++i) {
      RecordBody(i, reading.bodies[i], stamp_ns, arrives);
    }
  }

  void RecordBody(std::size_t i, const BodyReading& body, std::int64_t stamp_ns,
                  VirtualTime arrives) {
    std::string name = TopicOf(spec_.name);
    if (spec_.bodies.size() > 1) name += "/" + dds::RosToken(body.name);
    const bool has_state =
        Has(spec_, SensorField::kPosition) || Has(spec_, SensorField::kOrientation) ||
        Has(spec_, SensorField::kLinearVelocity) || Has(spec_, SensorField::kAngularVelocity);
    const bool is_felt =
        Has(spec_, SensorField::kAngularRate) || Has(spec_, SensorField::kProperAcceleration);
    if (has_state) {
      records_.Write(&states_[i], name, dds::NameOf(dds::SensorMessage::kOdometry), arrives,
                     dds::ToCdr(dds::ToOdometry(stamp_ns, body.name, Carried(spec_, body.state))));
    }
    if (is_felt) {
      records_.Write(&felt_[i], name + (has_state ? "/imu" : ""),
                     dds::NameOf(dds::SensorMessage::kImu), arrives,
                     dds::ToCdr(dds::ToImu(stamp_ns, body.name, body.state, body.felt)));
    }
  }

  ChannelRecords& records_;
  const SensorChannelSpec& spec_;
  std::vector<Topic> states_, felt_;  // of each body; other sensors use the first
};

// Stands between an inlet and the sink that gets its commands.
class ChannelRecords::Listener final : public CommandSink {
 public:
  Listener(ChannelRecords& records, std::vector<Topic>& topics, CommandSink& sink)
      : records_(records), topics_(topics), sink_(sink) {}

  void Take(std::size_t channel, const CommandSent& sent, const Wrench& wrench) override {
    Note(channel, sent.at, dds::CommandMessage::kWrench, [&] { return dds::ToMessage(wrench); });
    sink_.Take(channel, sent, wrench);
  }
  void Take(std::size_t channel, const CommandSent& sent,
            std::span<const JointGoal> goals) override {
    Note(channel, sent.at, dds::CommandMessage::kJointState, [&] {
      return dds::ToMessage(records_.sink_->StampOf(sent.at), sink_.GoalsOf(channel)->names, goals);
    });
    sink_.Take(channel, sent, goals);
  }
  void Take(std::size_t channel, const CommandSent& sent, const PlanarSpeed& speed) override {
    Note(channel, sent.at, dds::CommandMessage::kTwist, [&] { return dds::ToMessage(speed); });
    sink_.Take(channel, sent, speed);
  }
  void Take(std::size_t channel, const CommandSent& sent,
            const JointTrajectory& trajectory) override {
    Note(channel, sent.at, dds::CommandMessage::kJointTrajectory, [&] {
      const auto offset = VirtualDuration::Nanoseconds(records_.sink_->StampOf({}));
      return dds::ToMessage(offset, sink_.GoalsOf(channel)->names, trajectory);
    });
    sink_.Take(channel, sent, trajectory);
  }
  std::optional<GoalNames> GoalsOf(std::size_t channel) const override {
    return sink_.GoalsOf(channel);
  }
  void Refuse(std::size_t channel, const std::string& why) override { sink_.Refuse(channel, why); }
  void Note(const std::string& sentence) override { sink_.Note(sentence); }

 private:
  template <class Make>
  void Note(std::size_t channel, VirtualTime sent, dds::CommandMessage type, Make make) {
    const CommandChannelSpec& spec = records_.scenario_.commands[channel];
    // Commands that come in on DDS are recorded there.
    if (records_.sink_ == nullptr || std::holds_alternative<DdsCommandEnd>(spec.from)) return;
    if (topics_.size() <= channel) topics_.resize(channel + 1);
    records_.Write(&topics_[channel], TopicOf(spec.name), dds::NameOf(type), sent,
                   dds::ToCdr(make()));
  }

  ChannelRecords& records_;
  std::vector<Topic>& topics_;
  CommandSink& sink_;
};

class ChannelRecords::WrappedInlet final : public Inlet {
 public:
  WrappedInlet(ChannelRecords& records, std::unique_ptr<Inlet> inlet)
      : records_(records), inlet_(std::move(inlet)) {}

  int fd() const override { return inlet_->fd(); }
  bool IsTerminal() const override { return inlet_->IsTerminal(); }
  void Receive(const CommandSent& now, CommandSink& sink) override {
    Listener listener(records_, topics_, sink);
    inlet_->Receive(now, listener);
  }
  void Accept(std::string_view datagram, const CommandSent& sent, CommandSink& sink) override {
    Listener listener(records_, topics_, sink);
    inlet_->Accept(datagram, sent, listener);
  }
  Place PlaceOf(std::size_t channel) const override { return inlet_->PlaceOf(channel); }

 private:
  ChannelRecords& records_;
  std::unique_ptr<Inlet> inlet_;
  std::vector<Topic> topics_;  // as the scenario numbers commands
};

std::unique_ptr<Outlet> ChannelRecords::Wrap(std::size_t sensor, std::unique_ptr<Outlet> outlet) {
  return std::make_unique<WrappedOutlet>(*this, scenario_.sensors[sensor], std::move(outlet));
}

std::unique_ptr<Inlet> ChannelRecords::Wrap(std::unique_ptr<Inlet> inlet) {
  return std::make_unique<WrappedInlet>(*this, std::move(inlet));
}

}  // namespace tcs
