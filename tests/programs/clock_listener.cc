// Says of each sample of rt/clock what it says, and what CLOCK_REALTIME is, in ns, until it is
// stopped.
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "dds/dds.h"
#include "rosgraph_msgs.h"
#include "tests/programs/dds_program.h"

int main() {
  const dds_entity_t participant =
      OrDie(dds_create_participant(0, nullptr, nullptr), "make a participant");
  const dds_entity_t topic =
      OrDie(dds_create_topic(participant, &rosgraph_msgs_msg_dds__Clock__desc, "rt/clock", nullptr,
                             nullptr),
            "make a topic");
  const dds_entity_t reader =
      OrDie(dds_create_reader(participant, topic, nullptr, nullptr), "make a reader");
  const dds_entity_t waits = OrDie(dds_create_waitset(participant), "make a waitset");
  dds_set_status_mask(reader, DDS_DATA_AVAILABLE_STATUS);
  OrDie(dds_waitset_attach(waits, reader, 0), "attach the reader");
  for (;;) {
    OrDie(dds_waitset_wait(waits, nullptr, 0, DDS_INFINITY), "wait");
    void* sample = nullptr;
    dds_sample_info_t info;
    while (OrDie(dds_take(reader, &sample, &info, 1, 1), "take") > 0) {
      const auto& time = static_cast<const rosgraph_msgs_msg_dds__Clock_*>(sample)->clock;
      timespec now;
      clock_gettime(CLOCK_REALTIME, &now);
      if (info.valid_data) {
        printf("%lld %lld\n", time.sec * 1'000'000'000ll + time.nanosec,
               now.tv_sec * 1'000'000'000ll + now.tv_nsec);
        fflush(stdout);
      }
      dds_return_loan(reader, &sample, 1);
    }
  }
}
