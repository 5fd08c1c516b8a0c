// A node as ROS 2's middleware on Cyclone DDS makes it: guard conditions and waitsets before any
// domain, a participant that says its enclave, the hashes of types, samples as bytes.
//   rmw_like talker | rmw_like listener
// Both say what DDS knows them and each other by, and the listener what it has taken, when.
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <string>

#include "dds/dds.h"
#include "dds/ddsi/ddsi_serdata.h"
#include "std_msgs.h"

namespace {

constexpr int kSamples = 20;

dds_return_t OrDie(dds_return_t result, const char* what) {
  if (result >= 0) return result;
  fprintf(stderr, "cannot %s: %s\n", what, dds_strretcode(result));
  exit(1);
}

struct Qos {
  explicit Qos(const char* user_data) {
    dds_qset_userdata(qos, user_data, strlen(user_data));
    dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, DDS_INFINITY);
    dds_qset_history(qos, DDS_HISTORY_KEEP_LAST, 10);
  }
  ~Qos() { dds_delete_qos(qos); }
  dds_qos_t* const qos = dds_create_qos();
};

void Tell(const char* what, dds_entity_t entity) {
  dds_guid_t guid{};
  dds_instance_handle_t instance = 0;
  dds_get_instance_handle(entity, &instance);
  printf("%s: handle %x, instance %llx", what, static_cast<unsigned>(entity),
         static_cast<unsigned long long>(instance));
  if (dds_get_guid(entity, &guid) == DDS_RETCODE_OK) {
    printf(", GUID ");
    for (const unsigned char byte : guid.v) printf("%02x", byte);
  }
  printf("\n");
}

void Talk(dds_entity_t participant, dds_entity_t topic, const Qos& qos) {
  const dds_entity_t writer =
      OrDie(dds_create_writer(participant, topic, qos.qos, nullptr), "write");
  Tell("writer", writer);
  dds_instance_handle_t reader = 0;
  while (dds_get_matched_subscriptions(writer, &reader, 1) < 1) dds_sleepfor(DDS_MSECS(1));
  printf("reader: instance %llx\n", static_cast<unsigned long long>(reader));
  for (int i = 0; i < kSamples; ++i) {
    std::string text = "sample " + std::to_string(i);
    std_msgs_msg_dds__String_ sample{text.data()};
    OrDie(dds_write(writer, &sample), "write a sample");
    dds_sleepfor(DDS_MSECS(10));
  }
}

void TakeAll(dds_entity_t reader, int* taken) {
  ddsi_serdata* data = nullptr;
  dds_sample_info_t info;
  while (OrDie(dds_takecdr(reader, &data, 1, &info, DDS_ANY_STATE), "take") > 0) {
    std::string bytes;
    if (info.valid_data) {
      bytes.resize(ddsi_serdata_size(data));
      ddsi_serdata_to_ser(data, 0, bytes.size(), bytes.data());
      ++*taken;
    }
    ddsi_serdata_unref(data);
    printf("%s of %llx, sent at %lld, taken at %lld:", info.valid_data ? "a sample" : "news",
           static_cast<unsigned long long>(info.publication_handle),
           static_cast<long long>(info.source_timestamp), static_cast<long long>(dds_time()));
    for (const unsigned char byte : bytes) printf(" %02x", byte);
    printf("\n");
  }
}

void Listen(dds_entity_t participant, dds_entity_t topic, const Qos& qos, dds_entity_t waitset) {
  const dds_entity_t reader =
      OrDie(dds_create_reader(participant, topic, qos.qos, nullptr), "read");
  Tell("reader", reader);
  const dds_entity_t condition =
      OrDie(dds_create_readcondition(reader, DDS_ANY_STATE), "make a condition");
  OrDie(dds_waitset_attach(waitset, condition, condition), "attach");
  for (int taken = 0; taken < kSamples;) {
    dds_attach_t woken = 0;
    if (OrDie(dds_waitset_wait(waitset, &woken, 1, DDS_SECS(10)), "wait") == 0) exit(1);
    TakeAll(reader, &taken);
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  // As rcl's contexts do, which know of no domain yet.
  const dds_entity_t guard = OrDie(dds_create_guardcondition(DDS_CYCLONEDDS_HANDLE), "guard");
  const dds_entity_t waitset = OrDie(dds_create_waitset(DDS_CYCLONEDDS_HANDLE), "make a waitset");
  OrDie(dds_waitset_attach(waitset, guard, guard), "attach");
  Tell("guard condition", guard);
  Tell("waitset", waitset);
  const Qos of_participant("enclave=/;");
  const dds_entity_t participant =
      OrDie(dds_create_participant(DDS_DOMAIN_DEFAULT, of_participant.qos, nullptr), "join");
  Tell("participant", participant);
  const Qos of_endpoints(
      "typehash=RIHS01_df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18;");
  const dds_entity_t topic = OrDie(dds_create_topic(participant, &std_msgs_msg_dds__String__desc,
                                                    "rt/chatter", of_endpoints.qos, nullptr),
                                   "make a topic");
  if (strcmp(argv[1], "talker") == 0) {
    Talk(participant, topic, of_endpoints);
  } else {
    Listen(participant, topic, of_endpoints, waitset);
  }
  OrDie(dds_delete(DDS_CYCLONEDDS_HANDLE), "leave");
  return 0;
}
