// A program of a robot, on Cyclone DDS with ROS 2's messages: reads topics and says each sample on
// stdout as a line of JSON, the topic first, then all fields of the message by name; writes
// commands. It knows nothing of tcs.
//
//   robot_probe SECONDS WHAT...
//
// WHAT is one of:
//
//   KIND:/TOPIC
//     is read: imu, odometry, scan, joints, cloud, range, image, gnss, magnetic, pressure, bool,
//     transforms; fixed (transforms) and text also as they were said before
//   twist:/TOPIC:FORWARD:TURN
//     is written every 100 ms
//   trajectory:/TOPIC:JOINT:ANGLE:SECONDS[:ANGLE:SECONDS]
//     is written once, as soon as somebody reads it
//   hold:/STATES:/EFFORTS:ANGLE
//     holds a pendulum of 1 kg and 1 m there, by efforts
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "dds/dds.h"
#include "geometry_msgs.h"
#include "nav_msgs.h"
#include "sensor_msgs.h"
#include "std_msgs.h"
#include "tf2_msgs.h"
#include "trajectory_msgs.h"

namespace {

dds_return_t OrDie(dds_return_t result, const std::string& what) {
  if (result >= 0) return result;
  fprintf(stderr, "cannot %s: %s\n", what.c_str(), dds_strretcode(result));
  exit(1);
}

// An object of JSON.
class Json {
 public:
  Json& Add(const char* name, const std::string& raw) {
    text_ += (text_.empty() ? "{\"" : ", \"") + std::string(name) + "\": " + raw;
    return *this;
  }
  Json& Add(const char* name, double value) { return Add(name, Number(value)); }
  Json& Add(const char* name, const char* value) {
    return Add(name, '"' + std::string(value) + '"');
  }
  template <class Value>
  Json& Add(const char* name, const Value* values, std::size_t count) {
    std::string list = "[";
    for (std::size_t i = 0; i < count; ++i) {
      list += (i == 0 ? "" : ", ") + Number(static_cast<double>(values[i]));
    }
    return Add(name, list + "]");
  }
  Json& Add(const char* name, const geometry_msgs_msg_dds__Vector3_& v) {
    return Add(name, &v.x, 3);
  }
  Json& Add(const char* name, const geometry_msgs_msg_dds__Quaternion_& q) {
    return Add(name, &q.x, 4);
  }
  Json& Add(const std_msgs_msg_dds__Header_& header) {
    return Add("stamp", header.stamp.sec + 1e-9 * header.stamp.nanosec)
        .Add("frame_id", header.frame_id);
  }
  std::string text() const { return text_ + "}"; }

 private:
  static std::string Number(double value) {
    if (isinf(value)) return value > 0 ? "Infinity" : "-Infinity";
    char digits[40];
    snprintf(digits, sizeof digits, "%.17g", value);
    return digits;
  }
  std::string text_;
};

void Tell(const sensor_msgs_msg_dds__Imu_& imu, Json* json) {
  json->Add(imu.header)
      .Add("orientation", imu.orientation)
      .Add("angular_velocity", imu.angular_velocity)
      .Add("linear_acceleration", imu.linear_acceleration)
      .Add("known", imu.linear_acceleration_covariance[0] < 0 ? "no" : "yes");
}

void Tell(const nav_msgs_msg_dds__Odometry_& odometry, Json* json) {
  json->Add(odometry.header)
      .Add("child_frame_id", odometry.child_frame_id)
      .Add("position", &odometry.pose.pose.position.x, 3)
      .Add("orientation", odometry.pose.pose.orientation)
      .Add("linear", odometry.twist.twist.linear)
      .Add("angular", odometry.twist.twist.angular);
}

void Tell(const sensor_msgs_msg_dds__LaserScan_& scan, Json* json) {
  json->Add(scan.header)
      .Add("angle_min", scan.angle_min)
      .Add("angle_max", scan.angle_max)
      .Add("angle_increment", scan.angle_increment)
      .Add("time_increment", scan.time_increment)
      .Add("scan_time", scan.scan_time)
      .Add("range_min", scan.range_min)
      .Add("range_max", scan.range_max)
      .Add("ranges", scan.ranges._buffer, scan.ranges._length);
}

void Tell(const sensor_msgs_msg_dds__JointState_& joints, Json* json) {
  json->Add(joints.header)
      .Add("position", joints.position._buffer, joints.position._length)
      .Add("velocity", joints.velocity._buffer, joints.velocity._length)
      .Add("effort", joints.effort._buffer, joints.effort._length);
}

// The first points, each as its fields say.
void Tell(const sensor_msgs_msg_dds__PointCloud2_& cloud, Json* json) {
  std::string fields;
  for (std::size_t i = 0; i < cloud.fields._length; ++i)
    fields += cloud.fields._buffer[i].name + std::string(" ");
  std::vector<double> numbers;
  for (std::size_t i = 0; i < cloud.width * cloud.height; ++i) {
    const unsigned char* point = cloud.data._buffer + i * cloud.point_step;
    for (std::size_t field = 0; field < 4; ++field) {
      float value;
      memcpy(&value, point + cloud.fields._buffer[field].offset, sizeof value);
      numbers.push_back(value);
    }
    unsigned short ring;
    memcpy(&ring, point + cloud.fields._buffer[4].offset, sizeof ring);
    numbers.push_back(ring);
  }
  json->Add(cloud.header)
      .Add("fields", fields.c_str())
      .Add("points", numbers.data(), numbers.size());
}

void Tell(const sensor_msgs_msg_dds__Range_& range, Json* json) {
  json->Add(range.header)
      .Add("radiation_type", range.radiation_type)
      .Add("field_of_view", range.field_of_view)
      .Add("min_range", range.min_range)
      .Add("max_range", range.max_range)
      .Add("range", range.range)
      .Add("variance", range.variance);
}

void Tell(const sensor_msgs_msg_dds__Image_& image, Json* json) {
  std::vector<float> depths(image.data._length / sizeof(float));
  memcpy(depths.data(), image.data._buffer, depths.size() * sizeof(float));
  json->Add(image.header)
      .Add("height", image.height)
      .Add("width", image.width)
      .Add("encoding", image.encoding)
      .Add("step", image.step)
      .Add("depths", depths.data(), depths.size());
}

void Tell(const sensor_msgs_msg_dds__NavSatFix_& fix, Json* json) {
  json->Add(fix.header)
      .Add("status", fix.status.status)
      .Add("latitude", fix.latitude)
      .Add("longitude", fix.longitude)
      .Add("altitude", fix.altitude);
}

void Tell(const sensor_msgs_msg_dds__MagneticField_& magnetic, Json* json) {
  json->Add(magnetic.header).Add("field", magnetic.magnetic_field);
}

void Tell(const sensor_msgs_msg_dds__FluidPressure_& pressure, Json* json) {
  json->Add(pressure.header).Add("pressure", pressure.fluid_pressure);
}

void Tell(const tf2_msgs_msg_dds__TFMessage_& message, Json* json) {
  std::string list;
  for (std::size_t i = 0; i < message.transforms._length; ++i) {
    const auto& transform = message.transforms._buffer[i];
    Json one;
    one.Add(transform.header)
        .Add("child_frame_id", transform.child_frame_id)
        .Add("translation", transform.transform.translation)
        .Add("rotation", transform.transform.rotation);
    list += (i == 0 ? "" : ", ") + one.text();
  }
  json->Add("transforms", "[" + list + "]");
}

void Tell(const std_msgs_msg_dds__Bool_& message, Json* json) {
  json->Add("data", std::string(message.data ? "true" : "false"));
}

void Tell(const std_msgs_msg_dds__String_& text, Json* json) {
  json->Add("length", static_cast<double>(strlen(text.data)))
      .Add("begins", std::string(text.data).substr(0, 5).c_str());
}

// What is done once, and after every wait.
using Step = std::function<void()>;

struct Program {
  dds_entity_t participant = OrDie(dds_create_participant(0, nullptr, nullptr), "join domain 0");
  dds_entity_t waitset = OrDie(dds_create_waitset(participant), "make a waitset");
  std::vector<Step> on_data, on_time;

  dds_entity_t Topic(const dds_topic_descriptor_t& type, const std::string& name) {
    return OrDie(dds_create_topic(participant, &type, ("rt" + name).c_str(), nullptr, nullptr),
                 name);
  }
  dds_entity_t Reader(const dds_topic_descriptor_t& type, const std::string& topic,
                      bool is_latched = false) {
    dds_qos_t* qos = dds_create_qos();
    if (is_latched) dds_qset_durability(qos, DDS_DURABILITY_TRANSIENT_LOCAL);
    dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, DDS_SECS(1));
    dds_qset_history(qos, DDS_HISTORY_KEEP_ALL, 0);
    const dds_entity_t reader =
        OrDie(dds_create_reader(participant, Topic(type, topic), qos, nullptr), "make a reader");
    dds_delete_qos(qos);
    const dds_entity_t condition =
        OrDie(dds_create_readcondition(reader, DDS_ANY_STATE), "make a condition");
    OrDie(dds_waitset_attach(waitset, condition, 0), "wait for a topic");
    return reader;
  }
  dds_entity_t Writer(const dds_topic_descriptor_t& type, const std::string& topic) {
    dds_qos_t* qos = dds_create_qos();
    dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, DDS_SECS(1));
    const dds_entity_t writer =
        OrDie(dds_create_writer(participant, Topic(type, topic), qos, nullptr), "make a writer");
    dds_delete_qos(qos);
    return writer;
  }

  template <class Message>
  static void TakeAll(dds_entity_t reader, const std::function<void(const Message&)>& take) {
    void* sample = nullptr;
    dds_sample_info_t info;
    while (OrDie(dds_take(reader, &sample, &info, 1, 1), "take") > 0) {
      if (info.valid_data) take(*static_cast<const Message*>(sample));
      OrDie(dds_return_loan(reader, &sample, 1), "return a sample");
    }
  }

  template <class Message>
  void Read(const dds_topic_descriptor_t& type, const std::string& topic, bool is_latched = false) {
    on_data.push_back([topic, reader = Reader(type, topic, is_latched)] {
      TakeAll<Message>(reader, [&](const Message& message) {
        Json json;
        json.Add("topic", topic.c_str());
        Tell(message, &json);
        puts(json.text().c_str());
      });
    });
  }

  void WriteTwist(const std::string& topic, double forward, double turn) {
    const dds_entity_t writer = Writer(geometry_msgs_msg_dds__Twist__desc, topic);
    on_time.push_back([=] {
      const geometry_msgs_msg_dds__Twist_ twist{{forward, 0, 0}, {0, 0, turn}};
      OrDie(dds_write(writer, &twist), "write a twist");
    });
  }

  void WriteTrajectory(const std::string& topic, const std::string& joint,
                       const std::vector<double>& numbers) {
    const dds_entity_t writer = Writer(trajectory_msgs_msg_dds__JointTrajectory__desc, topic);
    on_time.push_back([=, written = false]() mutable {
      dds_publication_matched_status_t matched;
      OrDie(dds_get_publication_matched_status(writer, &matched), "look who reads");
      if (written || matched.current_count == 0) return;
      written = true;
      std::string name = joint, frame;
      char* names[] = {name.data()};
      std::vector<double> positions;
      for (std::size_t i = 0; i < numbers.size(); i += 2) positions.push_back(numbers[i]);
      std::vector<trajectory_msgs_msg_dds__JointTrajectoryPoint_> points(positions.size());
      for (std::size_t i = 0; i < points.size(); ++i) {
        points[i].positions = {1, 1, &positions[i], false};
        const double at = numbers[2 * i + 1];
        points[i].time_from_start = {static_cast<int>(at),
                                     static_cast<unsigned>((at - floor(at)) * 1e9)};
      }
      const auto count = static_cast<std::uint32_t>(points.size());
      trajectory_msgs_msg_dds__JointTrajectory_ trajectory{};
      trajectory.header.frame_id = frame.data();
      trajectory.joint_names = {1, 1, names, false};
      trajectory.points = {count, count, points.data(), false};
      OrDie(dds_write(writer, &trajectory), "write a trajectory");
    });
  }

  void Hold(const std::string& states, const std::string& efforts, double angle) {
    const dds_entity_t reader = Reader(sensor_msgs_msg_dds__JointState__desc, states);
    const dds_entity_t writer = Writer(std_msgs_msg_dds__Float64MultiArray__desc, efforts);
    on_data.push_back([=] {
      TakeAll<sensor_msgs_msg_dds__JointState_>(reader, [&](const auto& joints) {
        const double position = joints.position._buffer[0], velocity = joints.velocity._buffer[0];
        double effort = 9.81 * sin(angle) + 60 * (angle - position) - 12 * velocity;
        std_msgs_msg_dds__Float64MultiArray_ command{};
        command.data._buffer = &effort;
        command.data._length = command.data._maximum = 1;
        OrDie(dds_write(writer, &command), "write an effort");
      });
    });
  }

  void Do(const std::vector<std::string>& what) {
    const std::string& kind = what[0];
    if (kind == "imu")
      return Read<sensor_msgs_msg_dds__Imu_>(sensor_msgs_msg_dds__Imu__desc, what[1]);
    if (kind == "odometry")
      return Read<nav_msgs_msg_dds__Odometry_>(nav_msgs_msg_dds__Odometry__desc, what[1]);
    if (kind == "scan")
      return Read<sensor_msgs_msg_dds__LaserScan_>(sensor_msgs_msg_dds__LaserScan__desc, what[1]);
    if (kind == "joints")
      return Read<sensor_msgs_msg_dds__JointState_>(sensor_msgs_msg_dds__JointState__desc, what[1]);
    if (kind == "cloud")
      return Read<sensor_msgs_msg_dds__PointCloud2_>(sensor_msgs_msg_dds__PointCloud2__desc,
                                                     what[1]);
    if (kind == "range")
      return Read<sensor_msgs_msg_dds__Range_>(sensor_msgs_msg_dds__Range__desc, what[1]);
    if (kind == "image")
      return Read<sensor_msgs_msg_dds__Image_>(sensor_msgs_msg_dds__Image__desc, what[1]);
    if (kind == "gnss")
      return Read<sensor_msgs_msg_dds__NavSatFix_>(sensor_msgs_msg_dds__NavSatFix__desc, what[1]);
    if (kind == "magnetic")
      return Read<sensor_msgs_msg_dds__MagneticField_>(sensor_msgs_msg_dds__MagneticField__desc,
                                                       what[1]);
    if (kind == "pressure")
      return Read<sensor_msgs_msg_dds__FluidPressure_>(sensor_msgs_msg_dds__FluidPressure__desc,
                                                       what[1]);
    if (kind == "transforms")
      return Read<tf2_msgs_msg_dds__TFMessage_>(tf2_msgs_msg_dds__TFMessage__desc, what[1]);
    if (kind == "fixed")
      return Read<tf2_msgs_msg_dds__TFMessage_>(tf2_msgs_msg_dds__TFMessage__desc, what[1], true);
    if (kind == "text")
      return Read<std_msgs_msg_dds__String_>(std_msgs_msg_dds__String__desc, what[1], true);
    if (kind == "bool") return Read<std_msgs_msg_dds__Bool_>(std_msgs_msg_dds__Bool__desc, what[1]);
    if (kind == "twist") return WriteTwist(what[1], std::stod(what[2]), std::stod(what[3]));
    if (kind == "trajectory") {
      std::vector<double> numbers;
      for (std::size_t i = 3; i < what.size(); ++i) numbers.push_back(std::stod(what[i]));
      return WriteTrajectory(what[1], what[2], numbers);
    }
    if (kind == "hold") return Hold(what[1], what[2], std::stod(what[3]));
    fprintf(stderr, "nobody knows what '%s' is\n", kind.c_str());
    exit(2);
  }
};

std::vector<std::string> Split(const std::string& text) {
  std::vector<std::string> parts = {""};
  for (const char c : text) {
    if (c == ':') {
      parts.emplace_back();
    } else {
      parts.back() += c;
    }
  }
  return parts;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) return 2;
  const double seconds = atof(argv[1]);
  Program program;
  for (int i = 2; i < argc; ++i) program.Do(Split(argv[i]));
  const dds_time_t end = dds_time() + static_cast<dds_time_t>(seconds * 1e9);
  dds_time_t tick = dds_time();
  while (tick < end) {
    for (const Step& step : program.on_time) step();
    tick += DDS_MSECS(100);
    while (dds_time() < tick) {
      dds_attach_t attached;
      dds_waitset_wait_until(program.waitset, &attached, 1, tick);
      for (const Step& step : program.on_data) step();
    }
  }
  fflush(stdout);
  OrDie(dds_delete(program.participant), "leave");
  return 0;
}
