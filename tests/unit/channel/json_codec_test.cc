#include "coordinator/channel/json/json_codec.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <utility>
#include <vector>

namespace tcs {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

std::string ComplaintAbout(std::string_view datagram) {
  const auto result = DecodeCommand(datagram);
  const auto* error = std::get_if<DecodeError>(&result);
  return error != nullptr ? error->message : "";
}

Wrench Decoded(std::string_view datagram) {
  const auto result = DecodeCommand(datagram);
  if (const auto* error = std::get_if<DecodeError>(&result)) {
    ADD_FAILURE() << error->message;
    return {};
  }
  return std::get<Wrench>(result);
}

std::string Encoded(VirtualTime time, std::vector<BodyReading> bodies) {
  return EncodeReading({time, std::move(bodies)}, SensorChannelSpec().fields);
}

TEST(SensorDatagram, NamesTimeFrameAndStates) {
  BodyReading predator{"predator", {}};
  predator.state.position_m = {-5, 0.25, 1e-9};
  predator.state.linear_velocity_mps = {1, 2, 3};
  predator.state.angular_velocity_radps = {0, 0, 0.5};
  EXPECT_EQ(Encoded(VirtualTime::FromNanoseconds(1'230'000'000), {predator}),
            R"({"time":1.23,"frame_id":"world","bodies":{"predator":{"position":[-5.0,0.25,1e-09],)"
            R"("orientation":[0.0,0.0,0.0,1.0],"linear_velocity":[1.0,2.0,3.0],)"
            R"("angular_velocity":[0.0,0.0,0.5]}}})");
}

TEST(SensorDatagram, KeepsTheOrderOfTheBodies) {
  const std::string datagram = Encoded(VirtualTime(), {{"zeta", {}}, {"alpha", {}}});
  EXPECT_LT(datagram.find("zeta"), datagram.find("alpha"));
  EXPECT_EQ(Encoded(VirtualTime(), {}), R"({"time":0.0,"frame_id":"world","bodies":{}})");
}

TEST(SensorDatagram, TimesAreTheNearestDoubles) {
  for (std::int64_t ms = 0; ms < 100'000; ms += 10) {
    const std::string datagram = Encoded(VirtualTime::FromNanoseconds(ms * 1'000'000), {});
    const std::string decimal =
        std::to_string(ms / 1000) + "." + std::to_string(1000 + ms % 1000).substr(1);
    ASSERT_EQ(std::strtod(datagram.c_str() + 8, nullptr), std::strtod(decimal.c_str(), nullptr));
  }
}

TEST(SensorDatagram, DoublesReadBackAsTheyWere) {
  std::uint64_t bits = 88172645463325252u;
  for (int i = 0; i < 20'000; ++i) {
    bits ^= bits << 13;
    bits ^= bits >> 7;
    bits ^= bits << 17;
    const double value = std::ldexp(static_cast<double>(bits), i % 400 - 200);
    BodyReading body{"b", {}};
    body.state.position_m = {value, -value, 1 / value};
    const std::string datagram = Encoded(VirtualTime(), {body});
    const char* at = datagram.c_str() + datagram.find("[") + 1;
    for (const double expected : body.state.position_m) {
      char* end = nullptr;
      ASSERT_EQ(std::strtod(at, &end), expected) << datagram;
      at = end + 1;
    }
  }
}

TEST(CommandDatagram, IsAWrench) {
  const Wrench wrench = Decoded(R"({"force": [1, -2.5, 3e-1], "torque": [0, 0, 4]})");
  EXPECT_THAT(wrench.force_n, ElementsAre(1, -2.5, 0.3));
  EXPECT_THAT(wrench.torque_nm, ElementsAre(0, 0, 4));
}

class Draws {
 public:
  std::uint64_t operator()(std::uint64_t below) {
    bits_ ^= bits_ << 13;
    bits_ ^= bits_ >> 7;
    bits_ ^= bits_ << 17;
    return bits_ % below;
  }

 private:
  std::uint64_t bits_ = 88172645463325252u;
};

// Numbers as JSON has them, and what is like one.
constexpr std::string_view kPieces[] = {"0",
                                        "-0",
                                        "12",
                                        "-7",
                                        ".5",
                                        "1.",
                                        "01",
                                        "1.25",
                                        "-0.0",
                                        "1e3",
                                        "2E-3",
                                        "3e+2",
                                        "4e",
                                        "-",
                                        "nan",
                                        "+1",
                                        "1e-400",
                                        "9007199254740993",
                                        "18446744073709551617",
                                        "123456789012345678901234567890",
                                        "0.1",
                                        "5e-324"};
constexpr std::string_view kBlanks[] = {"", " ", "\t\n", "\r  "};

// Piece by piece, with the same blanks before each.
struct WrittenTwice {
  explicit WrittenTwice(Draws& its_draw) : draw(its_draw) {}

  void Add(std::string_view text, std::string_view other) {
    const std::string_view blank = kBlanks[draw(std::size(kBlanks))];
    plain.append(blank).append(text);
    escaped.append(blank).append(other);
  }
  void Add(std::string_view text) { Add(text, text); }

  Draws& draw;
  std::string plain, escaped;
};

// Plain commands are read in another way than all others; a blank key makes one of the others of it
// by an escape, which means the same.
TEST(CommandDatagram, IsTheSameHoweverItIsWritten) {
  Draws draw;
  int commands = 0;
  for (int i = 0; i < 20'000; ++i) {
    WrittenTwice command(draw);
    command.Add("{");
    for (std::uint64_t n = 0, count = draw(3); n < count; ++n) {
      if (n > 0) command.Add(",");
      const bool is_force = draw(2) == 0;
      command.Add(is_force ? "\"force\"" : "\"torque\"",
                  is_force ? "\"\\u0066orce\"" : "\"\\u0074orque\"");
      command.Add(":");
      for (int axis = 0; axis < 3; ++axis) {
        command.Add(axis == 0 ? "[" : ",");
        const std::string_view number = kPieces[draw(std::size(kPieces))];
        command.Add(number);
      }
      command.Add("]");
    }
    command.Add("}");
    const auto a = DecodeCommand(command.plain), b = DecodeCommand(command.escaped);
    ASSERT_EQ(a.index(), b.index()) << command.plain;
    const auto *x = std::get_if<Wrench>(&a), *y = std::get_if<Wrench>(&b);
    if (x == nullptr) continue;
    ++commands;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      ASSERT_EQ(std::bit_cast<std::uint64_t>(x->force_n[axis]),
                std::bit_cast<std::uint64_t>(y->force_n[axis]))
          << command.plain;
      ASSERT_EQ(std::bit_cast<std::uint64_t>(x->torque_nm[axis]),
                std::bit_cast<std::uint64_t>(y->torque_nm[axis]))
          << command.plain;
    }
  }
  EXPECT_GT(commands, 5000);
}

TEST(SensorDatagram, NamesAreEscapedAsJsonHasIt) {
  EXPECT_THAT(Encoded(VirtualTime(), {{"a\"b\\c\n", {}}}), HasSubstr(R"({"a\"b\\c\n":{)"));
  EXPECT_THAT(Encoded(VirtualTime(), {{"größe", {}}}), HasSubstr("{\"größe\":{"));
}

TEST(CommandDatagram, WhatIsLeftOutIsZero) {
  EXPECT_THAT(Decoded(R"({"torque":[1,2,3]})").force_n, ElementsAre(0, 0, 0));
  EXPECT_THAT(Decoded(R"({"force":[1,2,3]})").torque_nm, ElementsAre(0, 0, 0));
  EXPECT_THAT(Decoded("{}\n").force_n, ElementsAre(0, 0, 0));
}

TEST(CommandDatagram, ThatIsNoObjectIsExplained) {
  EXPECT_THAT(ComplaintAbout(""), HasSubstr("is not valid JSON"));
  EXPECT_THAT(ComplaintAbout("{\"force\":"), AllOf(HasSubstr("not valid JSON at byte 10"),
                                                   HasSubstr("send an object like {\"force\"")));
  EXPECT_THAT(ComplaintAbout("{} {}"), HasSubstr("is not valid JSON"));
  EXPECT_THAT(ComplaintAbout("\xff\xfe"), HasSubstr("is not valid JSON"));
  EXPECT_THAT(ComplaintAbout("[1,2,3]"), HasSubstr("is of the type array"));
  EXPECT_THAT(ComplaintAbout("null"), HasSubstr("is of the type null"));
  EXPECT_NE(ComplaintAbout(std::string(60'000, '[')), "");
}

TEST(CommandDatagram, OfTheWrongShapeIsExplained) {
  for (const char* value : {"[1,2]", "[1,2,3,4]", "1", "null", "[1,2,\"3\"]", "[1,2,true]",
                            "{\"x\":1}", "[[1],2,3]", "[1,2,null]"}) {
    EXPECT_THAT(ComplaintAbout("{\"torque\":" + std::string(value) + "}"),
                HasSubstr("has a torque that is not a list of three finite numbers"))
        << value;
  }
}

TEST(CommandDatagram, ThatIsNotFiniteIsRefused) {
  EXPECT_NE(ComplaintAbout(R"({"force":[NaN,0,0]})"), "");
  EXPECT_NE(ComplaintAbout(R"({"force":[Infinity,0,0]})"), "");
  EXPECT_THAT(ComplaintAbout(R"({"force":[1e999,0,0]})"), HasSubstr("too large"));
}

TEST(CommandDatagram, UnknownKeysAreNamed) {
  EXPECT_THAT(ComplaintAbout(R"({"forse":[1,2,3]})"), HasSubstr("unknown key \"forse\""));
  EXPECT_THAT(ComplaintAbout("{\"a\\nb\u00e9\":1}"), HasSubstr("\"a\\nb\\u00e9\""));
  EXPECT_LT(ComplaintAbout("{\"" + std::string(5000, 'x') + "\":1}").size(), 200u);
}

TEST(JointDatagram, NamesTimeAndStates) {
  const Reading reading{VirtualTime::FromNanoseconds(1'230'000'000),
                        {},
                        {{"elbow", {0.5, -1, 2}}, {"wrist", {1e-9, 0, 0}}}};
  EXPECT_EQ(EncodeJoints(reading),
            R"({"time":1.23,"joints":{"elbow":{"position":0.5,"velocity":-1.0,"effort":2.0},)"
            R"("wrist":{"position":1e-09,"velocity":0.0,"effort":0.0}}})");
}

std::variant<std::vector<JointGoal>, DecodeError> DecodedJoints(std::string_view text) {
  const std::vector<std::string> joints = {"elbow", "wrist"};
  return DecodeJointCommand(text, joints, JointQuantity::kVelocity);
}

std::string JointComplaint(std::string_view text) {
  const auto decoded = DecodedJoints(text);
  const auto* error = std::get_if<DecodeError>(&decoded);
  return error == nullptr ? "" : error->message;
}

TEST(JointCommandDatagram, IsForAnyOfTheJoints) {
  const JointGoal wrist{.joint = 1, .velocity = 0.5};
  EXPECT_THAT(std::get<0>(DecodedJoints(R"({"wrist": 0.5})")), ElementsAre(wrist));
  const JointGoal elbow{.joint = 0, .position = 1, .velocity = 2, .effort = -3};
  EXPECT_THAT(std::get<0>(DecodedJoints(
                  R"({"elbow":{"effort":-3,"position":1,"velocity":2},"wrist":0.5})")),
              ElementsAre(elbow, wrist));
  EXPECT_TRUE(std::get<0>(DecodedJoints("{}")).empty());
}

// As of wrenches: an escape makes one of the others of a plain command.
TEST(JointCommandDatagram, IsTheSameHoweverItIsWritten) {
  Draws draw;
  int commands = 0;
  for (int i = 0; i < 20'000; ++i) {
    WrittenTwice command(draw);
    command.Add("{");
    for (std::uint64_t n = 0, count = draw(4); n < count; ++n) {
      if (n > 0) command.Add(",");
      const bool is_elbow = draw(2) == 0;
      command.Add(is_elbow ? "\"elbow\"" : "\"wrist\"",
                  is_elbow ? "\"\\u0065lbow\"" : "\"\\u0077rist\"");
      command.Add(":");
      const std::string_view number = kPieces[draw(std::size(kPieces))];
      command.Add(number);
    }
    command.Add("}");
    const auto a = DecodedJoints(command.plain), b = DecodedJoints(command.escaped);
    ASSERT_EQ(a.index(), b.index()) << command.plain;
    const auto *x = std::get_if<0>(&a), *y = std::get_if<0>(&b);
    if (x == nullptr) continue;
    ++commands;
    ASSERT_EQ(*x, *y) << command.plain;
    for (std::size_t n = 0; n < x->size(); ++n) {
      ASSERT_EQ(std::signbit(*(*x)[n].velocity), std::signbit(*(*y)[n].velocity)) << command.plain;
    }
  }
  EXPECT_GT(commands, 5000);
}

TEST(JointCommandDatagram, ThatIsNoneIsSaid) {
  EXPECT_THAT(JointComplaint("[1]"), HasSubstr("is of the type array"));
  EXPECT_THAT(JointComplaint("{"), HasSubstr("is not valid JSON"));
  EXPECT_THAT(JointComplaint(R"({"knee":1})"), HasSubstr("names \"knee\""));
  EXPECT_THAT(JointComplaint(R"({"elbow":"up"})"), HasSubstr("value of \"elbow\" that is neither"));
  EXPECT_THAT(JointComplaint(R"({"elbow":{"speed":1}})"), HasSubstr("unknown key \"speed\""));
  EXPECT_THAT(JointComplaint(R"({"elbow":{"effort":null}})"),
              HasSubstr("whose effort is not a finite number"));
  EXPECT_THAT(JointComplaint(R"({"elbow":1e999})"), HasSubstr("too large"));
  EXPECT_THAT(JointComplaint(R"({"knee":1})"), HasSubstr(R"(send an object like {"elbow": 0.5})"));
}

Reading Measured(const Measurement& measured) {
  return {VirtualTime::FromNanoseconds(1'230'000'000), {}, {}, measured};
}

TEST(JsonCodec, WhatAnImuFeels) {
  ImuMeasurement imu{.frame = "imu", .felt = {{0.5, 0, 0}, {}}};
  EXPECT_EQ(EncodeReading(Measured(imu), {}),
            R"({"time":1.23,"frame_id":"imu","orientation":[0.0,0.0,0.0,1.0],)"
            R"("angular_rate":[0.5,0.0,0.0],"proper_acceleration":null})");
  imu.felt.proper_acceleration_mps2 = {0, 0, 9.81};
  EXPECT_THAT(EncodeReading(Measured(imu), {}),
              HasSubstr(R"("proper_acceleration":[0.0,0.0,9.81]})"));
}

TEST(JsonCodec, WhereARobotIs) {
  const OdometryMeasurement odometry{
      .frame = "world", .child_frame = "base", .pose = {{1, 2, 3}, {0, 0, 0, 1}}};
  EXPECT_EQ(EncodeReading(Measured(odometry), {}),
            R"({"time":1.23,"frame_id":"world","child_frame_id":"base","position":[1.0,2.0,3.0],)"
            R"("orientation":[0.0,0.0,0.0,1.0],"linear_velocity":[0.0,0.0,0.0],)"
            R"("angular_velocity":[0.0,0.0,0.0]})");
}

// JSON has no infinity.
TEST(JsonCodec, WhatALidarSees) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const ScanMeasurement scan{.frame = "laser",
                             .first_rad = -1,
                             .step_rad = 0.5,
                             .ray_s = 0.01,
                             .scan_s = 0.1,
                             .least_m = 0.2,
                             .most_m = 8,
                             .ranges_m = {1.5, kInfinity, -kInfinity}};
  EXPECT_EQ(EncodeReading(Measured(scan), {}),
            R"({"time":1.23,"frame_id":"laser","angle_min":-1.0,"angle_increment":0.5,)"
            R"("time_increment":0.01,"scan_time":0.1,"range_min":0.2,"range_max":8.0,)"
            R"("ranges":[1.5,null,0.0]})");
}

TEST(JsonCodec, TheVelocityOfARobotOnWheels) {
  const auto decoded = DecodeSpeed(R"({"linear": [0.5, 0, 0], "angular": [0, 0, -0.25]})");
  EXPECT_EQ(std::get<PlanarSpeed>(decoded), (PlanarSpeed{0.5, -0.25}));
  EXPECT_EQ(std::get<PlanarSpeed>(DecodeSpeed("{}")), PlanarSpeed{});
  const auto wrong = DecodeSpeed(R"({"linear": 0.5})");
  EXPECT_THAT(std::get<DecodeError>(wrong).message, HasSubstr("not a list of three"));
  EXPECT_THAT(std::get<DecodeError>(DecodeSpeed(R"({"x": 1})")).message, HasSubstr("unknown key"));
}

TEST(JsonCodec, WhereLinksAre) {
  const TransformsMeasurement transforms{{{"base", "wheel", {{1, 2, 3}, {0, 0, 0, 1}}}}};
  EXPECT_EQ(EncodeReading(Measured(transforms), {}),
            R"({"time":1.23,"transforms":[{"frame_id":"base","child_frame_id":"wheel",)"
            R"("translation":[1.0,2.0,3.0],"rotation":[0.0,0.0,0.0,1.0]}]})");
}

TEST(JsonCodec, WhatSmallSensorsMeasure) {
  const RangeMeasurement range{
      .frame = "sonar", .field_of_view_rad = 0.5, .least_m = 0.1, .most_m = 4, .range_m = 1.5};
  EXPECT_EQ(EncodeReading(Measured(range), {}),
            R"({"time":1.23,"frame_id":"sonar","field_of_view":0.5,"range_min":0.1,)"
            R"("range_max":4.0,"range":1.5})");
  EXPECT_EQ(EncodeReading(Measured(MagneticMeasurement{"mag", {0, 2e-5, 0}}), {}),
            R"({"time":1.23,"frame_id":"mag","magnetic_field":[0.0,2e-05,0.0]})");
  EXPECT_EQ(EncodeReading(Measured(PressureMeasurement{"baro", 101325}), {}),
            R"({"time":1.23,"frame_id":"baro","pressure":101325.0})");
  EXPECT_EQ(EncodeReading(Measured(ContactMeasurement{"foot", true}), {}),
            R"({"time":1.23,"frame_id":"foot","touches":true})");
}

std::string TrajectoryComplaint(std::string_view text) {
  const std::vector<std::string> joints = {"elbow", "wrist"};
  const auto decoded = DecodeTrajectory(text, joints);
  const auto* error = std::get_if<DecodeError>(&decoded);
  return error == nullptr ? "" : error->message;
}

TEST(JsonCodec, Trajectories) {
  const std::vector<std::string> joints = {"elbow", "wrist"};
  const auto decoded = DecodeTrajectory(
      R"({"joints": ["wrist"], "start": 2.5, "points":
          [{"positions": [0.5], "time_from_start": 1}, {"positions": [1], "velocities": [0], "time_from_start": 2}]})",
      joints);
  const auto& trajectory = std::get<JointTrajectory>(decoded);
  EXPECT_THAT(trajectory.joints, ElementsAre(1));
  EXPECT_EQ(trajectory.start, VirtualTime::FromNanoseconds(2'500'000'000));
  ASSERT_EQ(trajectory.points.size(), 2u);
  EXPECT_EQ(trajectory.points[0].at, VirtualDuration::Seconds(1));
  EXPECT_TRUE(trajectory.points[0].velocities.empty());
  EXPECT_THAT(trajectory.points[1].velocities, ElementsAre(0));
}

TEST(JsonCodec, WhatIsNoTrajectoryIsSaid) {
  EXPECT_THAT(TrajectoryComplaint("{}"), HasSubstr("has no points"));
  EXPECT_THAT(TrajectoryComplaint(R"({"joints": ["knee"], "points": []})"),
              HasSubstr(R"("knee", which the channel does not drive)"));
  EXPECT_THAT(TrajectoryComplaint(R"({"joints": ["wrist", "wrist"], "points": []})"),
              HasSubstr("twice"));
  EXPECT_THAT(TrajectoryComplaint(R"({"joints": ["wrist"], "points": [{"positions": [1]}]})"),
              HasSubstr("without positions or time_from_start"));
  EXPECT_THAT(TrajectoryComplaint(
                  R"({"joints": ["wrist"], "points": [{"positions": [], "time_from_start": 1}]})"),
              HasSubstr("another number"));
  EXPECT_THAT(
      TrajectoryComplaint(
          R"({"joints": ["wrist"], "points": [{"positions": [1], "time_from_start": -1}]})"),
      HasSubstr("no number of seconds"));
}

}  // namespace
}  // namespace tcs
