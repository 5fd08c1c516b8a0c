// examples/hover/hover_dds.c on Fast DDS: another vendor's middleware, which speaks DDS by sockets
// only. Reads Odometry, writes Wrench; says for each sample its number, when it was sent and when
// it came, in nanoseconds. Built by the test that runs it, where Fast DDS is found.
#include <fastcdr/Cdr.h>
#include <stdio.h>
#include <time.h>
#include <unistd.h>

#include <array>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/DataReaderListener.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/topic/TopicDataType.hpp>
#include <fastdds/dds/topic/TypeSupport.hpp>
#include <functional>
#include <memory>
#include <string>

using namespace eprosima::fastdds::dds;
using eprosima::fastrtps::rtps::InstanceHandle_t;
using eprosima::fastrtps::rtps::SerializedPayload_t;

namespace {

constexpr double kGoal[] = {1, 2, 3};               // m
constexpr double kStiffness = 4.0, kDamping = 4.0;  // N/m, N*s/m

struct Odometry {
  long long stamp_ns = 0;
  std::array<double, 3> position{}, velocity{};
};
struct Wrench {
  std::array<double, 3> force{}, torque{};
};

void Code(eprosima::fastcdr::Cdr& cdr, Odometry& to) {
  int seconds = 0;
  unsigned nanoseconds = 0;
  std::string frame, child;
  std::array<double, 4> orientation;
  std::array<double, 36> covariance;
  cdr >> seconds >> nanoseconds >> frame >> child >> to.position >> orientation >> covariance >>
      to.velocity;
  to.stamp_ns = seconds * 1'000'000'000ll + nanoseconds;
}

template <class Message>
class Type : public TopicDataType {
 public:
  explicit Type(const char* name) {
    setName(name);
    m_typeSize = 4096;
    m_isGetKeyDefined = false;
  }
  bool serialize(void* data, SerializedPayload_t* payload) override {
    if constexpr (std::is_same_v<Message, Wrench>) {
      eprosima::fastcdr::FastBuffer buffer(reinterpret_cast<char*>(payload->data),
                                           payload->max_size);
      eprosima::fastcdr::Cdr cdr(buffer, eprosima::fastcdr::Cdr::DEFAULT_ENDIAN,
                                 eprosima::fastcdr::Cdr::DDS_CDR);
      payload->encapsulation = CDR_LE;
      cdr.serialize_encapsulation();
      const auto* wrench = static_cast<const Wrench*>(data);
      cdr << wrench->force << wrench->torque;
      payload->length = static_cast<uint32_t>(cdr.getSerializedDataLength());
      return true;
    }
    return false;
  }
  bool deserialize(SerializedPayload_t* payload, void* data) override {
    if constexpr (std::is_same_v<Message, Odometry>) {
      eprosima::fastcdr::FastBuffer buffer(reinterpret_cast<char*>(payload->data), payload->length);
      eprosima::fastcdr::Cdr cdr(buffer, eprosima::fastcdr::Cdr::DEFAULT_ENDIAN,
                                 eprosima::fastcdr::Cdr::DDS_CDR);
      cdr.read_encapsulation();
      Code(cdr, *static_cast<Odometry*>(data));
      return true;
    }
    return false;
  }
  std::function<uint32_t()> getSerializedSizeProvider(void*) override {
    return [] { return 4096u; };
  }
  void* createData() override { return new Message; }
  void deleteData(void* data) override { delete static_cast<Message*>(data); }
  bool getKey(void*, InstanceHandle_t*, bool) override { return false; }
};

class Controller : public DataReaderListener {
 public:
  DataWriter* writer = nullptr;

  void on_data_available(DataReader* reader) override {
    Odometry odometry;
    SampleInfo info;
    while (reader->take_next_sample(&odometry, &info) == ReturnCode_t::RETCODE_OK) {
      if (!info.valid_data) continue;
      timespec now;
      clock_gettime(CLOCK_REALTIME, &now);
      printf("%d %lld %lld %lld\n", ++count_, odometry.stamp_ns,
             static_cast<long long>(info.source_timestamp.to_ns()),
             now.tv_sec * 1'000'000'000ll + now.tv_nsec);
      Wrench wrench;
      for (int i = 0; i < 3; ++i)
        wrench.force[i] =
            kStiffness * (kGoal[i] - odometry.position[i]) - kDamping * odometry.velocity[i];
      writer->write(&wrench);
    }
  }

 private:
  int count_ = 0;
};

}  // namespace

int main() {
  setvbuf(stdout, nullptr, _IOLBF, 0);
  DomainParticipant* participant =
      DomainParticipantFactory::get_instance()->create_participant(0, PARTICIPANT_QOS_DEFAULT);
  if (participant == nullptr) return 1;
  TypeSupport(new Type<Odometry>("nav_msgs::msg::dds_::Odometry_")).register_type(participant);
  TypeSupport(new Type<Wrench>("geometry_msgs::msg::dds_::Wrench_")).register_type(participant);
  Topic* odom =
      participant->create_topic("rt/odom", "nav_msgs::msg::dds_::Odometry_", TOPIC_QOS_DEFAULT);
  Topic* wrench = participant->create_topic("rt/wrench", "geometry_msgs::msg::dds_::Wrench_",
                                            TOPIC_QOS_DEFAULT);
  Controller controller;
  controller.writer = participant->create_publisher(PUBLISHER_QOS_DEFAULT)
                          ->create_datawriter(wrench, DATAWRITER_QOS_DEFAULT);
  DataReaderQos qos = DATAREADER_QOS_DEFAULT;
  qos.reliability().kind = RELIABLE_RELIABILITY_QOS;
  qos.history().kind = KEEP_ALL_HISTORY_QOS;
  participant->create_subscriber(SUBSCRIBER_QOS_DEFAULT)->create_datareader(odom, qos, &controller);
  for (;;) pause();
}
