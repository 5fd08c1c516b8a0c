// What a writer and a reader can learn of each other: who is matched, and their GUIDs,
// participants, topics, types and QoS.
#include "tests/dds/support/process.h"
#include "tests/dds/support/samples.h"

namespace {

using namespace dds_test;

// What each process tells the other around DDS, to compare with.
struct Identity {
  dds_guid_t endpoint, participant;
};

Identity Own(Process& self, dds_entity_t endpoint) {
  Identity own;
  OK(dds_get_guid(endpoint, &own.endpoint));
  OK(dds_get_guid(self.participant, &own.participant));
  return own;
}

bool Same(const dds_guid_t& a, const dds_guid_t& b) { return memcmp(&a, &b, sizeof a) == 0; }

void TellOf(dds_builtintopic_endpoint_t* data, const Identity& other) {
  Event("topic %s, type %s", data->topic_name, data->type_name);
  Event("its GUID is %s, its participant's %s", Same(data->key, other.endpoint) ? "right" : "wrong",
        Same(data->participant_key, other.participant) ? "right" : "wrong");
  dds_reliability_kind_t reliability;
  dds_durability_kind_t durability;
  dds_duration_t deadline;
  dds_qget_reliability(data->qos, &reliability, nullptr);
  dds_qget_durability(data->qos, &durability);
  dds_qget_deadline(data->qos, &deadline);
  char** partitions;
  std::uint32_t count;
  dds_qget_partition(data->qos, &count, &partitions);
  void* user;
  std::size_t size;
  dds_qget_userdata(data->qos, &user, &size);
  Event("%s, %s, deadline %lld ms, partition %s, user data %s",
        reliability == DDS_RELIABILITY_RELIABLE ? "reliable" : "best effort",
        durability == DDS_DURABILITY_TRANSIENT_LOCAL ? "transient-local" : "volatile",
        static_cast<long long>(deadline / DDS_NSECS_IN_MSEC), count == 1 ? partitions[0] : "?",
        static_cast<const char*>(user));
  for (std::uint32_t i = 0; i < count; i++) dds_free(partitions[i]);
  dds_free(partitions);
  dds_free(user);
  dds_builtintopic_free_endpoint(data);
}

void Writer(Process& self) {
  const dds_entity_t writer = self.Writer(self.Topic(), Qos()
                                                            .Reliable()
                                                            .TransientLocal()
                                                            .Deadline(DDS_SECS(3))
                                                            .Partition("left")
                                                            .UserData("of the writer"));
  WaitForReaders(writer, 1);
  self.peer.Meet("matched");
  self.peer.Send(Own(self, writer));
  const auto other = self.peer.Receive<Identity>();
  dds_instance_handle_t handles[4];
  Event("matched readers: %d", OK(dds_get_matched_subscriptions(writer, handles, 4)));
  dds_builtintopic_endpoint_t* data = dds_get_matched_subscription_data(writer, handles[0]);
  if (data == nullptr) Fail("there is no data of the matched reader");
  TellOf(data, other);
  Event("of a handle that is none: %s",
        dds_get_matched_subscription_data(writer, handles[0] + 1) == nullptr ? "nothing" : "data");
}

void Reader(Process& self) {
  const dds_entity_t reader = self.Reader(
      self.Topic(),
      Qos().Reliable().Deadline(DDS_SECS(4)).Partition("left").UserData("of the reader"));
  // A reader in another partition sees nothing of it.
  const dds_entity_t apart = self.Reader(self.Topic(), Qos().Reliable().Partition("right"));
  WaitForWriters(reader, 1);
  self.peer.Meet("matched");
  self.peer.Send(Own(self, reader));
  const auto other = self.peer.Receive<Identity>();
  dds_instance_handle_t handles[4];
  Event("matched writers: %d", OK(dds_get_matched_publications(reader, handles, 4)));
  dds_builtintopic_endpoint_t* data = dds_get_matched_publication_data(reader, handles[0]);
  if (data == nullptr) Fail("there is no data of the matched writer");
  TellOf(data, other);
  Event("matched writers of the reader in another partition: %d",
        OK(dds_get_matched_publications(apart, handles, 4)));
}

}  // namespace

TCS_DDS_SCENARIO(matched_info, Writer, Reader);
