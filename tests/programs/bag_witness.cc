// Says on stdout what it reads from a robot's topics and what it writes to topics of its own, for a
// test that holds the recording of the run against it. Each sample is a line of JSON: the topic,
// the moment (read: the source timestamp; written: before and after the call), and all fields of
// the message in their order, as Cyclone has them.
//
//   bag_witness ROUNDS
// ends by itself after as many rounds, each of 10 virtual milliseconds.
#include <inttypes.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include <cstdint>
#include <string>
#include <vector>

#include "dds/dds.h"
#include "geometry_msgs.h"
#include "nav_msgs.h"
#include "rosgraph_msgs.h"
#include "sensor_msgs.h"
#include "tests/programs/dds_program.h"

namespace {

using Clock = rosgraph_msgs_msg_dds__Clock_;
using JointState = sensor_msgs_msg_dds__JointState_;
using Odometry = nav_msgs_msg_dds__Odometry_;
using Twist = geometry_msgs_msg_dds__Twist_;
using Wrench = geometry_msgs_msg_dds__Wrench_;

constexpr dds_duration_t kPeriod = DDS_MSECS(10);
constexpr int kElsewhere = 7;  // a domain without anybody else

// A sample's fields, one after the other.
class Fields {
 public:
  void Add(const std::string& json) { text_ += (text_.empty() ? "" : ", ") + json; }
  void Add(double value) {
    char digits[40];
    snprintf(digits, sizeof digits, "%.17g", value);
    Add(std::string(digits));
  }
  void AddWhole(std::int64_t value) { Add(std::to_string(value)); }
  void Add(const char* text) { Add("\"" + std::string(text) + "\""); }
  void Add(const double* values, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) Add(values[i]);
  }
  void Add(const geometry_msgs_msg_dds__Vector3_& v) {
    for (const double value : {v.x, v.y, v.z}) Add(value);
  }
  void Add(const Twist& twist) {
    Add(twist.linear);
    Add(twist.angular);
  }
  void Add(const builtin_interfaces_msg_dds__Time_& time) {
    AddWhole(time.sec);
    AddWhole(time.nanosec);
  }
  void Add(const dds_sequence_double& sequence) {
    AddWhole(sequence._length);
    Add(sequence._buffer, sequence._length);
  }
  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

Fields FieldsOf(const Clock& clock) {
  Fields fields;
  fields.Add(clock.clock);
  return fields;
}

Fields FieldsOf(const Odometry& odometry) {
  Fields fields;
  fields.Add(odometry.header.stamp);
  fields.Add(odometry.header.frame_id);
  fields.Add(odometry.child_frame_id);
  const auto& [position, orientation] = odometry.pose.pose;
  for (const double value : {position.x, position.y, position.z}) fields.Add(value);
  for (const double value : {orientation.x, orientation.y, orientation.z, orientation.w}) {
    fields.Add(value);
  }
  fields.Add(odometry.pose.covariance, 36);
  fields.Add(odometry.twist.twist);
  fields.Add(odometry.twist.covariance, 36);
  return fields;
}

Fields FieldsOf(const Wrench& wrench) {
  Fields fields;
  fields.Add(wrench.force);
  fields.Add(wrench.torque);
  return fields;
}

Fields FieldsOf(const Twist& twist) {
  Fields fields;
  fields.Add(twist);
  return fields;
}

Fields FieldsOf(const JointState& state) {
  Fields fields;
  fields.Add(state.header.stamp);
  fields.Add(state.header.frame_id);
  fields.AddWhole(state.name._length);
  for (std::size_t i = 0; i < state.name._length; ++i) fields.Add(state.name._buffer[i]);
  fields.Add(state.position);
  fields.Add(state.velocity);
  fields.Add(state.effort);
  return fields;
}

// A participant's end of a topic.
class End {
 public:
  End(dds_entity_t participant, const dds_topic_descriptor_t& type, const char* topic)
      : name_(topic),
        topic_(OrDie(dds_create_topic(participant, &type, topic, nullptr, nullptr), topic)) {}

  End& Writes(dds_entity_t participant, const dds_qos_t* qos) {
    end_ = OrDie(dds_create_writer(participant, topic_, qos, nullptr), "make a writer");
    return *this;
  }
  End& Reads(dds_entity_t participant, const dds_qos_t* qos) {
    end_ = OrDie(dds_create_reader(participant, topic_, qos, nullptr), "make a reader");
    return *this;
  }

  template <class Message>
  void Write(const Message& message) const {
    const dds_time_t before = dds_time();
    OrDie(dds_write(end_, &message), "write");
    printf("{\"written\": \"%s\", \"before\": %" PRId64 ", \"after\": %" PRId64
           ", \"fields\": [%s]}\n",
           name_, before, dds_time(), FieldsOf(message).text().c_str());
  }

  template <class Message>
  void SayAll() const {
    void* sample = nullptr;
    dds_sample_info_t info;
    while (OrDie(dds_take(end_, &sample, &info, 1, 1), "take") > 0) {
      if (info.valid_data) {
        printf("{\"read\": \"%s\", \"at\": %" PRId64 ", \"fields\": [%s]}\n", name_,
               info.source_timestamp,
               FieldsOf(*static_cast<const Message*>(sample)).text().c_str());
      }
      dds_return_loan(end_, &sample, 1);
    }
  }

 private:
  const char* name_;
  dds_entity_t topic_, end_ = 0;
};

dds_qos_t* Qos(dds_reliability_kind_t reliability, int depth) {
  dds_qos_t* qos = dds_create_qos();
  dds_qset_reliability(qos, reliability, DDS_MSECS(100));
  dds_qset_history(qos, depth == 0 ? DDS_HISTORY_KEEP_ALL : DDS_HISTORY_KEEP_LAST, depth);
  return qos;
}

// Of a length and with texts that are others each time.
void WriteRoute(const End& end, int round) {
  std::vector<std::string> names;
  std::vector<char*> name_pointers;
  std::vector<double> numbers;
  for (int i = 0; i < round % 4; ++i) {
    names.push_back(std::string(static_cast<std::size_t>(1 + (round + i) % 9), 'a'));
    numbers.push_back(0.1 * round + i);
  }
  for (std::string& name : names) name_pointers.push_back(name.data());
  const auto length = static_cast<std::uint32_t>(names.size());
  JointState state{};
  std::string frame = round % 2 == 0 ? "map" : "";
  state.header.frame_id = frame.data();
  state.header.stamp = {round, 7};
  state.name = {length, length, name_pointers.data(), false};
  state.position = {length, length, numbers.data(), false};
  state.effort = {length / 2, length / 2, numbers.data(), false};
  end.Write(state);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const int rounds = atoi(argv[1]);
  const dds_entity_t here = OrDie(dds_create_participant(0, nullptr, nullptr), "join domain 0");
  const dds_entity_t elsewhere =
      OrDie(dds_create_participant(kElsewhere, nullptr, nullptr), "join domain 7");
  dds_qos_t* all = Qos(DDS_RELIABILITY_RELIABLE, 0);
  const End odometry = End(here, nav_msgs_msg_dds__Odometry__desc, "rt/odom").Reads(here, all);
  const End clock = End(here, rosgraph_msgs_msg_dds__Clock__desc, "rt/clock").Reads(here, all);
  const End joints = End(here, sensor_msgs_msg_dds__JointState__desc, "rt/joints").Reads(here, all);
  dds_qos_t* newest = Qos(DDS_RELIABILITY_RELIABLE, 1);
  const End wrench =
      End(here, geometry_msgs_msg_dds__Wrench__desc, "rt/wrench").Writes(here, newest);
  dds_qos_t* latched = Qos(DDS_RELIABILITY_RELIABLE, 5);
  dds_qset_durability(latched, DDS_DURABILITY_TRANSIENT_LOCAL);
  dds_qset_deadline(latched, DDS_MSECS(2500));
  const End route =
      End(here, sensor_msgs_msg_dds__JointState__desc, "rt/route").Writes(here, latched);
  dds_qos_t* careless = Qos(DDS_RELIABILITY_BEST_EFFORT, 3);
  const End twist =
      End(elsewhere, geometry_msgs_msg_dds__Twist__desc, "rt/twist").Writes(elsewhere, careless);

  for (int round = 0; round < rounds; ++round) {
    wrench.Write(Wrench{{round * 0.1, -1.0 / (round + 1), 1e-300}, {0, 0, round % 3 * 1e-3}});
    WriteRoute(route, round);
    twist.Write(Twist{{round * 1.5, 0, 0}, {0, 0, -round / 7.0}});
    dds_sleepfor(kPeriod);
    clock.SayAll<Clock>();
    odometry.SayAll<Odometry>();
    joints.SayAll<JointState>();
  }
  OrDie(dds_delete(here), "leave domain 0");
  OrDie(dds_delete(elsewhere), "leave domain 7");
  return 0;
}
