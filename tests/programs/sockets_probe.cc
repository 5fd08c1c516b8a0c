// A robot's program whose DDS uses sockets: reads /odom and /clock, and writes a force on each
// sample of /odom; it gets the /robot_description even where it comes late. Says for each sample
// when it was written and when it came, in nanoseconds.
//
//   sockets_probe [DELAY_MS]    before it makes its participant
#include <string.h>

#include <cstdlib>
#include <string>

#include "coordinator/dds/ros_types.h"
#include "dds/dds.h"
#include "tests/programs/dds_program.h"

namespace {

using namespace tcs::dds;

template <class Message>
dds_entity_t Topic(dds_entity_t participant, const char* name) {
  return OrDie(dds_create_topic(participant, &DescriptorOf<Message>(), name, nullptr, nullptr),
               name);
}

template <class Message, class Tell>
void TakeAll(dds_entity_t reader, Tell tell) {
  void* sample = nullptr;
  dds_sample_info_t info;
  while (dds_take(reader, &sample, &info, 1, 1) == 1) {
    if (info.valid_data)
      tell(*static_cast<const Message*>(sample), (long long)info.source_timestamp);
    dds_return_loan(reader, &sample, 1);
    sample = nullptr;
  }
}

long long RealTime() { return Now(CLOCK_REALTIME); }

}  // namespace

int main(int argc, char** argv) {
  setvbuf(stdout, nullptr, _IOLBF, 0);
  if (argc > 1) {
    const long ms = atol(argv[1]);
    const timespec delay{ms / 1000, ms % 1000 * 1'000'000};
    nanosleep(&delay, nullptr);
  }
  const dds_entity_t participant =
      OrDie(dds_create_participant(0, nullptr, nullptr), "make a participant");
  dds_qos_t* all = dds_create_qos();
  dds_qset_reliability(all, DDS_RELIABILITY_RELIABLE, DDS_INFINITY);
  dds_qset_history(all, DDS_HISTORY_KEEP_ALL, 0);
  const auto read = [&](dds_entity_t topic, const dds_qos_t* qos) {
    return OrDie(dds_create_reader(participant, topic, qos, nullptr), "make a reader");
  };
  const dds_entity_t odom = read(Topic<OdometryMessage>(participant, "rt/odom"), all);
  const dds_entity_t clock = read(Topic<ClockMessage>(participant, "rt/clock"), all);
  dds_qset_durability(all, DDS_DURABILITY_TRANSIENT_LOCAL);
  const dds_entity_t description =
      read(Topic<StringMessage>(participant, "rt/robot_description"), all);
  dds_delete_qos(all);
  const dds_entity_t wrench =
      OrDie(dds_create_writer(participant, Topic<WrenchMessage>(participant, "rt/wrench"), nullptr,
                              nullptr),
            "make a writer");
  const dds_entity_t waitset = OrDie(dds_create_waitset(participant), "make a waitset");
  for (const dds_entity_t reader : {odom, clock, description}) {
    dds_set_status_mask(reader, DDS_DATA_AVAILABLE_STATUS);
    dds_waitset_attach(waitset, reader, 0);
  }
  printf("ready %lld\n", RealTime());
  for (int count = 0;;) {
    dds_waitset_wait(waitset, nullptr, 0, DDS_INFINITY);
    TakeAll<OdometryMessage>(odom, [&](const OdometryMessage& odometry, long long written) {
      const auto& stamp = odometry.header.stamp;
      printf("odom %lld %lld %lld\n", stamp.sec * 1'000'000'000ll + stamp.nanosec, written,
             RealTime());
      WrenchMessage message{};
      message.force.x = ++count;
      printf("sent %d %lld\n", count, RealTime());
      dds_write(wrench, &message);
    });
    TakeAll<ClockMessage>(clock, [](const ClockMessage& time, long long written) {
      printf("clock %lld %lld %lld\n", time.clock.sec * 1'000'000'000ll + time.clock.nanosec,
             written, RealTime());
    });
    TakeAll<StringMessage>(description, [](const StringMessage& text, long long) {
      printf("description %zu %lld\n", strlen(text.data), RealTime());
    });
  }
}
