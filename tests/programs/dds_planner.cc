// DDS programs that are always behind, as planners are: the next sample is there before they have
// worked on the one before.
//
//   dds_planner source    writes thirty samples of each topic below, one each 10 ms
//   dds_planner taking    takes one sample at a time, and asks again where there is none
//   dds_planner waiting   waits in a waitset for each
//   dds_planner loaned    takes each as a loan
//   dds_planner reading   only reads, which leaves samples where they are
//   dds_planner draining  takes all there are, and works on them for short
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include <cstdint>
#include <string>
#include <vector>

#include "dds/dds.h"
#include "rosgraph_msgs.h"
#include "tests/programs/dds_program.h"

namespace {

using Clock = rosgraph_msgs_msg_dds__Clock_;

constexpr int kCount = 30;
constexpr std::int64_t kMs = 1'000'000;
constexpr const char* kKinds[] = {"taking", "waiting", "loaned", "reading", "draining"};

dds_entity_t Topic(dds_entity_t participant, const char* kind) {
  return OrDie(dds_create_topic(participant, &rosgraph_msgs_msg_dds__Clock__desc,
                                (std::string("rt/") + kind).c_str(), nullptr, nullptr),
               "make a topic");
}

dds_qos_t* Reliable() {
  dds_qos_t* qos = dds_create_qos();
  dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, DDS_INFINITY);
  dds_qset_history(qos, DDS_HISTORY_KEEP_ALL, 0);
  dds_qset_durability(qos, DDS_DURABILITY_TRANSIENT_LOCAL);
  return qos;
}

void Write(dds_entity_t participant) {
  std::vector<dds_entity_t> writers;
  for (const char* kind : kKinds) {
    writers.push_back(
        OrDie(dds_create_writer(participant, Topic(participant, kind), Reliable(), nullptr),
              "make a writer"));
  }
  timespec begin{1000, 500 * kMs};  // of the run's clock
  clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &begin, nullptr);
  for (int i = 0; i < kCount; ++i) {
    for (const dds_entity_t writer : writers) {
      Clock clock{};
      clock.clock.sec = i;
      OrDie(dds_write(writer, &clock), "write");
    }
    dds_sleepfor(DDS_MSECS(10));
  }
  dds_sleepfor(DDS_SECS(1));
}

// How many came. `reading`: of one that leaves them, the next one.
int Receive(const std::string& kind, dds_entity_t reader) {
  Clock clock{};
  void* sample = &clock;
  dds_sample_info_t info;
  if (kind == "reading") {
    return OrDie(dds_read_mask(reader, &sample, &info, 1, 1, DDS_NOT_READ_SAMPLE_STATE), "read");
  }
  if (kind != "loaned") return OrDie(dds_take(reader, &sample, &info, 1, 1), "take");
  sample = nullptr;
  const dds_return_t count = OrDie(dds_take(reader, &sample, &info, 1, 1), "take a loan");
  if (count > 0) OrDie(dds_return_loan(reader, &sample, count), "return a loan");
  return count;
}

void Plan(const std::string& kind, dds_entity_t participant) {
  const dds_entity_t reader =
      OrDie(dds_create_reader(participant, Topic(participant, kind.c_str()), Reliable(), nullptr),
            "make a reader");
  const dds_entity_t waitset = OrDie(dds_create_waitset(participant), "make a waitset");
  OrDie(dds_set_status_mask(reader, DDS_DATA_AVAILABLE_STATUS), "set a mask");
  const dds_entity_t condition =
      OrDie(dds_create_readcondition(
                reader, DDS_NOT_READ_SAMPLE_STATE | DDS_ANY_VIEW_STATE | DDS_ANY_INSTANCE_STATE),
            "make a condition");
  OrDie(dds_waitset_attach(waitset, condition, 0), "attach a condition");
  for (int received = 0; received < kCount;) {
    if (kind != "taking") OrDie(dds_waitset_wait(waitset, nullptr, 0, DDS_INFINITY), "wait");
    int count = Receive(kind, reader);
    while (kind == "draining" && Receive(kind, reader) > 0) ++count;
    if (count == 0) continue;
    received += count;
    Compute(kind == "draining" ? 2 * kMs : 15 * kMs);
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const dds_entity_t participant =
      OrDie(dds_create_participant(0, nullptr, nullptr), "make a participant");
  if (strcmp(argv[1], "source") == 0) {
    Write(participant);
  } else {
    Plan(argv[1], participant);
  }
  puts("done");
  return 0;
}
