// Where the configurations ask for it (EnableTopicDiscoveryEndpoints), a topic is made known by
// itself: another program that knows neither it nor its type finds it, and reads what is written to
// it.
#include <dds/dds.h>

#include <cstring>

#include "tests/dds/support/process.h"
#include "tests/dds/support/waits.h"
#include "unknown.h"

namespace {

using namespace dds_test;

Qos Lasting() { return Plain().TransientLocal(); }

void UseTopicDiscovery(Process& self) {
  self.DomainBeside(
      "<Discovery><EnableTopicDiscoveryEndpoints>true</EnableTopicDiscoveryEndpoints></Discovery>");
  self.participant = self.Participant(1);
}

void Writer(Process& self) {
  UseTopicDiscovery(self);
  const dds_entity_t topic = OK(dds_create_topic(self.participant, &dds_unknown_Shape_desc, "a",
                                                 Qos().Reliable().get(), nullptr));
  const dds_entity_t writer = self.Writer(topic, Lasting());
  self.peer.Meet("made");
  char name[] = "nothing";
  const dds_unknown_Shape shape{name, dds_unknown_GREEN, {}};
  OK(dds_write(writer, &shape));
  self.peer.Meet("read");
  OK(dds_delete(writer));
  OK(dds_delete(topic));
  self.peer.Meet("gone");
}

// Waits for the topic's sample in that state.
void AwaitTopic(dds_entity_t topics, bool alive) {
  WaitUntil("the topic is on the built-in topic", [&] {
    void* samples[1] = {};
    dds_sample_info_t info;
    if (OK(dds_take(topics, samples, &info, 1, 1)) == 0) return false;
    const auto* topic = static_cast<dds_builtintopic_topic_t*>(samples[0]);
    const bool found = (info.instance_state == DDS_IST_ALIVE) == alive &&
                       (!info.valid_data || strcmp(topic->topic_name, "a") == 0);
    if (found && alive) Event("a topic of type %s", topic->type_name);
    OK(dds_return_loan(topics, samples, 1));
    return found;
  });
}

void Reader(Process& self) {
  UseTopicDiscovery(self);
  const dds_entity_t topics =
      OK(dds_create_reader(self.participant, DDS_BUILTIN_TOPIC_DCPSTOPIC, nullptr, nullptr));
  self.peer.Meet("made");
  AwaitTopic(topics, true);
  const dds_entity_t publications =
      OK(dds_create_reader(self.participant, DDS_BUILTIN_TOPIC_DCPSPUBLICATION, nullptr, nullptr));
  void* writing[1] = {};
  dds_sample_info_t info;
  WaitUntil("the writer is there",
            [&] { return OK(dds_take(publications, writing, &info, 1, 1)) == 1; });
  const dds_typeinfo_t* information = nullptr;
  OK(dds_builtintopic_get_endpoint_type_info(static_cast<dds_builtintopic_endpoint_t*>(writing[0]),
                                             &information));
  Event("in this process: %s", Code(dds_find_topic(DDS_FIND_SCOPE_LOCAL_DOMAIN, self.participant,
                                                   "a", information, DDS_MSECS(100))));
  Event("of any type: %s", Code(dds_find_topic(DDS_FIND_SCOPE_GLOBAL, self.participant, "a",
                                               nullptr, DDS_MSECS(100))));
  Event("of another name: %s", Code(dds_find_topic(DDS_FIND_SCOPE_GLOBAL, self.participant, "b",
                                                   information, DDS_MSECS(100))));
  const dds_entity_t topic =
      OK(dds_find_topic(DDS_FIND_SCOPE_GLOBAL, self.participant, "a", information, DDS_SECS(5)));
  OK(dds_return_loan(publications, writing, 1));
  char type[64];
  OK(dds_get_type_name(topic, type, sizeof type));
  dds_qos_t* qos = dds_create_qos();
  OK(dds_get_qos(topic, qos));
  dds_reliability_kind_t reliability = DDS_RELIABILITY_BEST_EFFORT;
  dds_qget_reliability(qos, &reliability, nullptr);
  dds_delete_qos(qos);
  Event("found: type %s, %s", type,
        reliability == DDS_RELIABILITY_RELIABLE ? "reliable" : "best effort");
  // The program's own.
  void* seen[1] = {};
  Event("topics since then: %d", OK(dds_take(topics, seen, &info, 1, 1)));
  const dds_entity_t reader = self.Reader(topic, Lasting());
  WaitUntil("there is a sample", [&] {
    void* samples[1] = {};
    dds_sample_info_t info;
    if (OK(dds_take(reader, samples, &info, 1, 1)) == 0) return false;
    Event("it says '%s'", static_cast<dds_unknown_Shape*>(samples[0])->name);
    OK(dds_return_loan(reader, samples, 1));
    return true;
  });
  OK(dds_delete(reader));
  OK(dds_delete(topic));
  self.peer.Meet("read");
  self.peer.Meet("gone");
  AwaitTopic(topics, false);
  Event("the topic is gone");
}

}  // namespace

TCS_DDS_SCENARIO(unknown_topics, Writer, Reader);
