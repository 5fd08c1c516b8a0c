// The built-in topics show the other process's participant and endpoints under their own GUIDs,
// with their QoS, and that they have gone.
#include <string>

#include "tests/dds/support/process.h"
#include "tests/dds/support/samples.h"

namespace {

using namespace dds_test;

struct Identity {
  dds_guid_t participant, endpoint;
};

void Writer(Process& self) {
  const dds_entity_t writer =
      self.Writer(self.Topic(), Qos().Reliable().TransientLocal().UserData("seen"));
  Identity own;
  OK(dds_get_guid(self.participant, &own.participant));
  OK(dds_get_guid(writer, &own.endpoint));
  self.peer.Send(own);
  self.peer.Await("seen");
  OK(dds_delete(writer));
  self.peer.Await("endpoint gone");
  OK(dds_delete(self.participant));
  self.peer.Await("participant gone");
  self.participant = self.Participant();
}

const char* State(dds_instance_state_t state) {
  return state == DDS_IST_ALIVE ? "alive" : "not alive";
}

// Looks until the sample with that GUID is there in that state.
template <class Builtin>
void Find(dds_entity_t reader, const dds_guid_t& guid, bool alive,
          void (*tell)(const Builtin&, const dds_sample_info_t&)) {
  WaitUntil("it is on the built-in topic", [&] {
    void* samples[32] = {};
    dds_sample_info_t infos[32];
    const int count = OK(dds_read(reader, samples, infos, 32, 32));
    bool found = false;
    for (int i = 0; i < count && !found; i++) {
      const auto& sample = *static_cast<const Builtin*>(samples[i]);
      found = memcmp(&sample.key, &guid, sizeof guid) == 0 &&
              (infos[i].instance_state == DDS_IST_ALIVE) == alive;
      if (found) tell(sample, infos[i]);
    }
    if (count > 0) OK(dds_return_loan(reader, samples, count));
    return found;
  });
}

void TellParticipant(const dds_builtintopic_participant_t&, const dds_sample_info_t& info) {
  Event("participant: %s", State(info.instance_state));
}

void TellEndpoint(const dds_builtintopic_endpoint_t& endpoint, const dds_sample_info_t& info) {
  if (!info.valid_data) {
    Event("publication: %s", State(info.instance_state));
    return;
  }
  dds_durability_kind_t durability;
  dds_qget_durability(endpoint.qos, &durability);
  void* user;
  std::size_t size;
  dds_qget_userdata(endpoint.qos, &user, &size);
  Event("publication: %s, topic %s, type %s, %s, user data %.*s", State(info.instance_state),
        endpoint.topic_name, endpoint.type_name,
        durability == DDS_DURABILITY_TRANSIENT_LOCAL ? "transient-local" : "another durability",
        static_cast<int>(size), static_cast<const char*>(user));
  dds_free(user);
}

void Reader(Process& self) {
  const dds_entity_t participants =
      OK(dds_create_reader(self.participant, DDS_BUILTIN_TOPIC_DCPSPARTICIPANT, nullptr, nullptr));
  const dds_entity_t publications =
      OK(dds_create_reader(self.participant, DDS_BUILTIN_TOPIC_DCPSPUBLICATION, nullptr, nullptr));
  const dds_entity_t reader =
      self.Reader(self.Topic(), Qos().Reliable().KeepAll().TransientLocal());
  const auto other = self.peer.Receive<Identity>();
  WaitForWriters(reader, 1);
  Find<dds_builtintopic_participant_t>(participants, other.participant, true, TellParticipant);
  Find<dds_builtintopic_endpoint_t>(publications, other.endpoint, true, TellEndpoint);
  self.peer.Reached("seen");
  Find<dds_builtintopic_endpoint_t>(publications, other.endpoint, false, TellEndpoint);
  self.peer.Reached("endpoint gone");
  Find<dds_builtintopic_participant_t>(participants, other.participant, false, TellParticipant);
  self.peer.Reached("participant gone");
}

}  // namespace

TCS_DDS_SCENARIO(builtin_topics, Writer, Reader);
