// Two nodes as rmw_cyclonedds makes them: a guard condition and a waitset before there is any
// domain, a thread that follows the graph, types in USER_DATA, serialized samples, an executor that
// waits in a waitset until its next timer.
//
//   rmw_pair talker COUNT      computes for 3 ms each 10 ms and says a number
//   rmw_pair listener COUNT    computes for 5 ms on each number; ends when it has heard them all
//
// Each says at its end what came when, from which writer, and what DDS knows it by: under set costs
// that is the same in each run, byte for byte.
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include <atomic>
#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "dds/dds.h"
#include "dds/ddsi/ddsi_serdata.h"
#include "rmw_dds_common_iron.h"
#include "rosgraph_msgs.h"
#include "tests/programs/dds_program.h"

namespace {

using Clock = rosgraph_msgs_msg_dds__Clock_;
using Graph = rmw_dds_common_iron_msg_dds__ParticipantEntitiesInfo_;

constexpr std::int64_t kMs = 1'000'000;
constexpr const char* kType =
    "typehash=RIHS01_692f7a66e93a3c83e71765d033b60349ba68023a8c689a79e48078bcb5c58564;";

dds_qos_t* Qos(bool is_latched) {
  dds_qos_t* qos = dds_create_qos();
  dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, DDS_INFINITY);
  dds_qset_history(qos, DDS_HISTORY_KEEP_LAST, is_latched ? 1 : 10);
  if (is_latched) dds_qset_durability(qos, DDS_DURABILITY_TRANSIENT_LOCAL);
  dds_qset_ignorelocal(qos, is_latched ? DDS_IGNORELOCAL_PARTICIPANT : DDS_IGNORELOCAL_NONE);
  dds_qset_userdata(qos, kType, strlen(kType));
  return qos;
}

// What DDS knows them by, here and everywhere.
void TellNames(std::initializer_list<dds_entity_t> entities) {
  for (const dds_entity_t entity : entities) {
    dds_guid_t guid;
    dds_instance_handle_t instance = 0;
    OrDie(dds_get_guid(entity, &guid), "get its GUID");
    OrDie(dds_get_instance_handle(entity, &instance), "get its number");
    printf("handle %d, number %llu, GUID ", entity, (unsigned long long)instance);
    for (const unsigned char byte : guid.v) printf("%02x", byte);
    printf("\n");
  }
}

class Node {
 public:
  explicit Node(const char* name) {
    changed_ = OrDie(dds_create_guardcondition(DDS_CYCLONEDDS_HANDLE), "make a guard condition");
    stops_ = OrDie(dds_create_guardcondition(DDS_CYCLONEDDS_HANDLE), "make a guard condition");
    waits_ = OrDie(dds_create_waitset(DDS_CYCLONEDDS_HANDLE), "make a waitset");
    follows_ = OrDie(dds_create_waitset(DDS_CYCLONEDDS_HANDLE), "make a waitset");
    dds_qos_t* qos = dds_create_qos();
    const std::string data = std::string("enclave=/;name=") + name + ";";
    dds_qset_userdata(qos, data.data(), data.size());
    participant_ = OrDie(dds_create_participant(0, qos, nullptr), "make a participant");
    dds_delete_qos(qos);
    const dds_entity_t graph =
        Topic("ros_discovery_info", &rmw_dds_common_iron_msg_dds__ParticipantEntitiesInfo__desc);
    qos = Qos(true);
    graph_reader_ = OrDie(dds_create_reader(participant_, graph, qos, nullptr), "make a reader");
    graph_writer_ = OrDie(dds_create_writer(participant_, graph, qos, nullptr), "make a writer");
    dds_delete_qos(qos);
    dds_set_status_mask(graph_reader_, DDS_DATA_AVAILABLE_STATUS);
    OrDie(dds_waitset_attach(follows_, graph_reader_, 0), "attach the reader");
    OrDie(dds_waitset_attach(follows_, stops_, 1), "attach the guard");
    OrDie(dds_waitset_attach(waits_, changed_, -1), "attach the guard");
    follower_ = std::thread([this] { FollowGraph(); });
    Tell();
  }
  ~Node() {
    dds_set_guardcondition(stops_, true);
    follower_.join();
    dds_delete(DDS_CYCLONEDDS_HANDLE);
  }

  dds_entity_t Topic(const char* name, const dds_topic_descriptor_t* type) const {
    return OrDie(dds_create_topic(participant_, type, name, nullptr, nullptr), "make a topic");
  }
  // What is talked about.
  dds_entity_t Chatter() const { return Topic("rt/chatter", &rosgraph_msgs_msg_dds__Clock__desc); }
  dds_entity_t participant() const { return participant_; }
  dds_entity_t waits() const { return waits_; }
  int seen() const { return seen_; }

  void Tell() const {
    Graph graph{};
    dds_guid_t guid;
    OrDie(dds_get_guid(participant_, &guid), "get its GUID");
    memcpy(graph.gid.data, guid.v, sizeof guid.v);
    OrDie(dds_write(graph_writer_, &graph), "tell of itself");
  }
  // True if something was there before that.
  bool WaitUntil(std::int64_t ns) const {
    dds_attach_t which[4];
    const std::int64_t left = ns - Now();
    const auto found = OrDie(dds_waitset_wait(waits_, which, 4, left > 0 ? left : 0), "wait");
    bool triggered;
    if (found > 0) dds_take_guardcondition(changed_, &triggered);
    return found > 0;
  }

 private:
  void FollowGraph() {
    for (;;) {
      dds_attach_t which[2];
      const int found = OrDie(dds_waitset_wait(follows_, which, 2, DDS_INFINITY), "follow");
      for (int i = 0; i < found; ++i) {
        if (which[i] == 1) return;
      }
      void* sample = nullptr;
      dds_sample_info_t info;
      while (OrDie(dds_take(graph_reader_, &sample, &info, 1, 1), "take") > 0) {
        if (info.valid_data) ++seen_;
        dds_return_loan(graph_reader_, &sample, 1);
        dds_set_guardcondition(changed_, true);
      }
    }
  }

  dds_entity_t changed_, stops_, waits_, follows_, participant_, graph_reader_, graph_writer_;
  std::atomic<int> seen_{0};
  std::thread follower_;
};

void Talk(int count) {
  Node node("talker");
  dds_qos_t* qos = Qos(false);
  const dds_entity_t writer =
      OrDie(dds_create_writer(node.participant(), node.Chatter(), qos, nullptr), "make a writer");
  dds_delete_qos(qos);
  node.Tell();
  dds_publication_matched_status_t matched{};
  while (matched.current_count == 0) {
    node.WaitUntil(Now() + 10 * kMs);
    OrDie(dds_get_publication_matched_status(writer, &matched), "ask whom it reaches");
  }
  std::int64_t next = Now();
  for (int i = 0; i < count; ++i) {
    next += 10 * kMs;
    while (Now() < next) node.WaitUntil(next);
    Compute(3 * kMs);
    Clock clock{};
    clock.clock.sec = i;
    OrDie(dds_write(writer, &clock), "say it");
  }
  OrDie(dds_wait_for_acks(writer, DDS_SECS(10)), "be heard");
  TellNames({node.participant(), writer});
  printf("talker said all at %lld, of the graph %d\n", (long long)Now(), node.seen());
}

void Listen(int count) {
  Node node("listener");
  dds_qos_t* qos = Qos(false);
  const dds_entity_t reader =
      OrDie(dds_create_reader(node.participant(), node.Chatter(), qos, nullptr), "make a reader");
  dds_delete_qos(qos);
  const dds_entity_t there =
      OrDie(dds_create_readcondition(reader, DDS_ANY_STATE), "make a read condition");
  OrDie(dds_waitset_attach(node.waits(), there, 0), "attach it");
  node.Tell();
  std::string heard;
  for (int next = 0; next < count;) {
    if (!node.WaitUntil(Now() + 100 * kMs)) continue;
    ddsi_serdata* sample = nullptr;
    dds_sample_info_t info;
    while (next < count &&
           OrDie(dds_takecdr(reader, &sample, 1, &info, DDS_ANY_STATE), "take") > 0) {
      if (info.valid_data) {
        std::int32_t number = 0;
        ddsi_serdata_to_ser(sample, 4, 4, &number);
        heard += std::to_string(number) + " at " + std::to_string(Now()) + " from " +
                 std::to_string(info.publication_handle) + "\n";
        if (number != next) OrDie(DDS_RETCODE_ERROR, "hear each number once, and in order");
        ++next;
        Compute(5 * kMs);
      }
      ddsi_serdata_unref(sample);
    }
  }
  TellNames({node.participant(), reader});
  printf("%slistener heard all, of the graph %d\n", heard.c_str(), node.seen());
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 3) return 2;
  const int numbers = atoi(arguments[2]);
  std::string_view(arguments[1]) == "talker" ? Talk(numbers) : Listen(numbers);
  return 0;
}
