// What goes over channels that are not on DDS is recorded as ROS 2 messages that say the same.
#include "coordinator/channel/recorded/channel_records.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "coordinator/dds/command_messages.h"
#include "coordinator/dds/robot_topics.h"
#include "coordinator/dds/ros_types.h"

namespace tcs {
namespace {

using testing::ElementsAre;
using testing::SizeIs;

constexpr std::int64_t kEpoch = 1'700'000'000'000'000'000;

VirtualTime At(std::int64_t ms) { return VirtualTime::FromNanoseconds(ms * 1'000'000); }

class Sink final : public record::MessageSink {
 public:
  struct Message {
    std::string topic, type;
    std::int64_t at_ns;
    std::vector<std::byte> cdr;
  };
  int AddOwnTopic(std::string_view name, std::string_view type) override {
    topics_.emplace_back(name, type);
    return static_cast<int>(topics_.size()) - 1;
  }
  void WriteOwn(int topic, VirtualTime at, std::span<const std::byte> cdr) override {
    const auto& [name, type] = topics_.at(static_cast<std::size_t>(topic));
    messages.push_back({name, type, at.ns(), {cdr.begin(), cdr.end()}});
  }
  std::int64_t StampOf(VirtualTime at) const override { return kEpoch + at.ns(); }

  std::vector<Message> messages;

 private:
  std::vector<std::pair<std::string, std::string>> topics_;
};

// An outlet that counts what goes out, and an inlet that gives away what it is told to.
class Counting final : public Outlet {
 public:
  explicit Counting(int* sent) : sent_(sent) {}
  bool Send(const Reading&, VirtualTime) override { return ++*sent_ % 2 == 0; }
  VirtualTime NextDue() const override { return At(7); }
  bool HandOver(VirtualTime) override { return true; }
  std::string WhyUnheard() const override { return "unheard"; }
  std::string WhatWasLost() const override { return "lost"; }

 private:
  int* sent_;
};

using Giving = std::function<void(CommandSink&)>;
class Told final : public Inlet {
 public:
  explicit Told(Giving give) : give_(std::move(give)) {}
  int fd() const override { return 42; }
  bool IsTerminal() const override { return true; }
  void Receive(const CommandSent&, CommandSink& sink) override { give_(sink); }
  Place PlaceOf(std::size_t) const override { return {"there", "mend it"}; }

 private:
  Giving give_;
};

class Taker final : public CommandSink {
 public:
  void Take(std::size_t, const CommandSent&, const Wrench&) override { ++taken; }
  void Take(std::size_t, const CommandSent&, std::span<const JointGoal>) override { ++taken; }
  void Take(std::size_t, const CommandSent&, const PlanarSpeed&) override { ++taken; }
  void Take(std::size_t, const CommandSent&, const JointTrajectory&) override { ++taken; }
  std::optional<GoalNames> GoalsOf(std::size_t) const override { return GoalNames{joints}; }
  void Refuse(std::size_t, const std::string&) override { ++refused; }
  void Note(const std::string&) override { ++notes; }

  const std::vector<std::string> joints = {"hip", "knee"};
  int taken = 0, refused = 0, notes = 0;
};

class ChannelRecordsTest : public testing::Test {
 protected:
  ChannelRecordsTest() {
    SensorChannelSpec& state = scenario_.sensors.emplace_back();
    state.name = "state";
    state.bodies = {0};
    SensorChannelSpec& fleet = scenario_.sensors.emplace_back();
    fleet.name = "fleet-state";
    fleet.bodies = {0, 1};
    fleet.fields = {SensorField::kPosition, SensorField::kOrientation, SensorField::kAngularRate};
    SensorChannelSpec& joints = scenario_.sensors.emplace_back();
    joints.name = "joints";
    joints.joints = {.model = "leg", .joints = {0, 1}, .names = {"hip", "knee"}};
    for (const char* name : {"drive", "other"}) scenario_.commands.emplace_back().name = name;
    scenario_.commands.emplace_back().from = DdsCommandEnd{};
  }

  void Send(std::size_t sensor, const Reading& reading, VirtualTime arrives) {
    const auto outlet = records_.Wrap(sensor, std::make_unique<Counting>(&sent_));
    outlet->Send(reading, arrives);
  }
  void Receive(Giving give) {
    records_.Wrap(std::make_unique<Told>(std::move(give)))->Receive(At(0), taker_);
  }
  template <class Message>
  dds::Owned<Message> Decoded(std::size_t message) const {
    auto decoded = dds::FromCdr<Message>(sink_.messages.at(message).cdr);
    if (const auto* error = std::get_if<dds::CdrError>(&decoded)) ADD_FAILURE() << error->message;
    return std::move(std::get<0>(decoded));
  }

  Scenario scenario_;
  ChannelRecords records_{scenario_};
  Sink sink_;
  Taker taker_;
  int sent_ = 0;
};

TEST_F(ChannelRecordsTest, AnEndDoesWhatItDidBefore) {
  const auto outlet = records_.Wrap(0, std::make_unique<Counting>(&sent_));
  EXPECT_FALSE(outlet->Send({}, At(1)));
  EXPECT_TRUE(outlet->Send({}, At(1)));
  EXPECT_EQ(outlet->NextDue(), At(7));
  EXPECT_TRUE(outlet->HandOver(At(7)));
  EXPECT_EQ(outlet->WhyUnheard() + outlet->WhatWasLost(), "unheardlost");
  const auto inlet = records_.Wrap(std::make_unique<Told>([](CommandSink& sink) {
    sink.Refuse(0, "");
    sink.Note("");
    sink.Take(0, At(0), Wrench{});
  }));
  EXPECT_EQ(inlet->fd(), 42);
  EXPECT_TRUE(inlet->IsTerminal());
  EXPECT_EQ(inlet->PlaceOf(0).where, "there");
  inlet->Receive(At(0), taker_);
  EXPECT_EQ(taker_.taken + taker_.refused + taker_.notes, 3);
  EXPECT_THAT(sink_.messages, SizeIs(0)) << "nobody has said that anything is recorded";
}

TEST_F(ChannelRecordsTest, AReadingIsThereWhenItArrivesAndSaysWhenItWasTaken) {
  records_.RecordInto(sink_);
  BodyState body;
  body.position_m = {1, 2, 3};
  body.linear_velocity_mps = {4, 5, 6};
  Send(0, {.at = At(10), .bodies = {{"ship", body, {}}}}, At(15));
  ASSERT_THAT(sink_.messages, SizeIs(1));
  EXPECT_EQ(sink_.messages[0].topic, "/channels/state");
  EXPECT_EQ(sink_.messages[0].type, "nav_msgs/msg/Odometry");
  EXPECT_EQ(sink_.messages[0].at_ns, At(15).ns());
  const auto odometry = Decoded<dds::OdometryMessage>(0);
  EXPECT_EQ(odometry->header.stamp.nanosec, 10'000'000u);
  EXPECT_EQ(odometry->pose.pose.position.z, 3);
  EXPECT_EQ(odometry->twist.twist.linear.x, 4);
}

TEST_F(ChannelRecordsTest, WhatAChannelDoesNotCarryIsNoNumber) {
  records_.RecordInto(sink_);
  BodyReading one{"one", {}, {.angular_rate_radps = {0, 0, 9}}};
  one.state.position_m = {1, 2, 3};
  BodyReading other = one;
  other.name = "other";
  Send(1, {.at = At(10), .bodies = {one, other}}, At(10));
  std::vector<std::string> topics;
  for (const auto& message : sink_.messages) topics.push_back(message.topic);
  EXPECT_THAT(topics,
              ElementsAre("/channels/fleet_state/one", "/channels/fleet_state/one/imu",
                          "/channels/fleet_state/other", "/channels/fleet_state/other/imu"));
  const auto odometry = Decoded<dds::OdometryMessage>(0);
  EXPECT_EQ(odometry->pose.pose.position.x, 1);
  EXPECT_EQ(odometry->pose.pose.orientation.w, 1);
  EXPECT_TRUE(std::isnan(odometry->twist.twist.linear.x));
  EXPECT_TRUE(std::isnan(odometry->twist.twist.angular.z));
  EXPECT_EQ(Decoded<dds::ImuMessage>(3)->angular_velocity.z, 9);
}

TEST_F(ChannelRecordsTest, JointsAndMeasurementsHaveTheirOwnMessages) {
  records_.RecordInto(sink_);
  Send(2, {.at = At(1), .joints = {{"hip", {.position = 1}}, {"knee", {.velocity = 2}}}}, At(1));
  const auto joints = Decoded<dds::JointStateMessage>(0);
  EXPECT_STREQ(joints->name._buffer[1], "knee");
  EXPECT_EQ(joints->velocity._buffer[1], 2);
  scenario_.sensors[2].joints.reset();
  scenario_.sensors[2].instrument.emplace();
  Reading pressed{.at = At(2)};
  pressed.measured = PressureMeasurement{.frame = "air", .pressure_pa = 101'325};
  Send(2, pressed, At(2));
  EXPECT_EQ(sink_.messages.at(1).type, "sensor_msgs/msg/FluidPressure");
  EXPECT_EQ(Decoded<dds::FluidPressureMessage>(1)->fluid_pressure, 101'325);
}

TEST_F(ChannelRecordsTest, CommandsAreThereWhenTheyWereSent) {
  records_.RecordInto(sink_);
  JointTrajectory trajectory{.joints = {1, 0}, .start = At(50)};
  trajectory.points = {{VirtualDuration::Milliseconds(1500), {1, 2}, {}}};
  Receive([&](CommandSink& sink) {
    sink.Take(0, At(1), Wrench{.force_n = {1, 2, 3}, .torque_nm = {4, 5, 6}});
    sink.Take(1, At(2), PlanarSpeed{.forward_mps = 2, .turn_radps = 3});
    const std::vector<JointGoal> goals = {{.joint = 1, .position = 7}, {.joint = 0, .effort = 8}};
    sink.Take(1, At(3), goals);
    sink.Take(1, At(4), trajectory);
    sink.Take(2, At(5), Wrench{});  // on DDS, where it is recorded anyway
  });
  EXPECT_EQ(taker_.taken, 5);
  ASSERT_THAT(sink_.messages, SizeIs(4));
  EXPECT_EQ(sink_.messages[0].topic, "/channels/drive");
  EXPECT_EQ(sink_.messages[0].at_ns, At(1).ns());
  const auto wrench = dds::DecodeCommand(dds::CommandMessage::kWrench, sink_.messages[0].cdr);
  EXPECT_THAT(std::get<Wrench>(wrench).force_n, ElementsAre(1, 2, 3));
  EXPECT_THAT(std::get<Wrench>(wrench).torque_nm, ElementsAre(4, 5, 6));
  EXPECT_EQ(std::get<PlanarSpeed>(dds::DecodeSpeed(sink_.messages[1].cdr)),
            (PlanarSpeed{.forward_mps = 2, .turn_radps = 3}));
  const auto goals = Decoded<dds::JointStateMessage>(2);
  EXPECT_STREQ(goals->name._buffer[0], "knee");
  EXPECT_EQ(goals->position._buffer[0], 7);
  EXPECT_TRUE(std::isnan(goals->position._buffer[1]));
  EXPECT_EQ(goals->velocity._length, 0u);
  EXPECT_EQ(goals->effort._buffer[1], 8);
  const auto decoded = dds::DecodeTrajectory(taker_.joints, VirtualDuration::Nanoseconds(kEpoch),
                                             sink_.messages[3].cdr);
  const auto& read = std::get<JointTrajectory>(decoded);
  EXPECT_EQ(read.joints, trajectory.joints);
  EXPECT_EQ(read.start, trajectory.start);
  EXPECT_EQ(read.points[0].at, trajectory.points[0].at);
  EXPECT_EQ(read.points[0].positions, trajectory.points[0].positions);
}

}  // namespace
}  // namespace tcs
