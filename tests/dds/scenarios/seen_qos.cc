// What a writer and a reader see of all of each other's policies: those that were set, the defaults
// of those that were not, and of which type they are; but not what is nobody else's business.
#include <string>

#include "tests/dds/support/process.h"
#include "tests/dds/support/samples.h"

namespace {

using namespace dds_test;

long long Ms(dds_duration_t d) { return d == DDS_INFINITY ? -1 : d / DDS_NSECS_IN_MSEC; }

void TellTexts(const char* who, const dds_qos_t* qos) {
  char* name = nullptr;
  dds_qget_entity_name(qos, &name);
  char** partitions = nullptr;
  std::uint32_t count = 0;
  dds_qget_partition(qos, &count, &partitions);
  std::string all;
  for (std::uint32_t i = 0; i < count; i++) {
    all += std::string(" ") + partitions[i];
    dds_free(partitions[i]);
  }
  dds_free(partitions);
  void *topic = nullptr, *group = nullptr;
  std::size_t topic_size = 0, group_size = 0;
  dds_qget_topicdata(qos, &topic, &topic_size);
  dds_qget_groupdata(qos, &group, &group_size);
  char* colour = nullptr;
  const bool has_colour = dds_qget_prop(qos, "colour", &colour);
  Event("%s: name %s, partitions%s, %zu bytes of topic data, %zu of group data, a property%s", who,
        name == nullptr ? "none" : name, all.c_str(), topic_size, group_size,
        has_colour ? "" : " unseen");
  for (void* text : {static_cast<void*>(name), topic, group, static_cast<void*>(colour)})
    dds_free(text);
}

void TellDurations(const char* who, const dds_qos_t* qos) {
  dds_duration_t blocking = -1, latency = -1, lease = -1, lifespan = -1, separation = -1;
  dds_reliability_kind_t reliability{};
  dds_liveliness_kind_t liveliness{};
  dds_qget_reliability(qos, &reliability, &blocking);
  dds_qget_latency_budget(qos, &latency);
  dds_qget_liveliness(qos, &liveliness, &lease);
  dds_qget_lifespan(qos, &lifespan);
  dds_qget_time_based_filter(qos, &separation);
  Event(
      "%s: reliability %d for %lld ms, latency %lld ms, liveliness %d for %lld ms, lifespan %lld "
      "ms, filter %lld ms",
      who, reliability, Ms(blocking), Ms(latency), liveliness, Ms(lease), Ms(lifespan),
      Ms(separation));
}

void TellNumbers(const char* who, const dds_qos_t* qos) {
  dds_history_kind_t history{};
  int depth = 0, samples = 0, instances = 0, per_instance = 0, priority = 0, strength = 0;
  dds_qget_history(qos, &history, &depth);
  dds_qget_resource_limits(qos, &samples, &instances, &per_instance);
  dds_qget_transport_priority(qos, &priority);
  dds_qget_ownership_strength(qos, &strength);
  dds_presentation_access_scope_kind_t scope{};
  bool coherent = false, ordered = false;
  dds_qget_presentation(qos, &scope, &coherent, &ordered);
  dds_ignorelocal_kind_t ignored{};
  dds_qget_ignorelocal(qos, &ignored);
  Event(
      "%s: history %d of %d, limits %d %d %d, priority %d, strength %d, presentation %d%s, "
      "ignores %d",
      who, history, depth, samples, instances, per_instance, priority, strength, scope,
      ordered ? " ordered" : "", ignored);
}

void TellOf(const char* who, dds_builtintopic_endpoint_t* data) {
  if (data == nullptr) Fail("there is no data of the %s", who);
  TellTexts(who, data->qos);
  TellDurations(who, data->qos);
  TellNumbers(who, data->qos);
  const dds_typeinfo_t* type = nullptr;
  OK(dds_builtintopic_get_endpoint_type_info(data, &type));
  Event("%s: its type is %s", who, type == nullptr ? "not described" : "described");
  dds_builtintopic_free_endpoint(data);
}

// Policies of both ends that suit each other.
dds_qos_t* Rich() {
  dds_qos_t* q = dds_create_qos();
  dds_qset_entity_name(q, "front");
  dds_qset_prop(q, "colour", "red");
  dds_qset_reliability(q, DDS_RELIABILITY_RELIABLE, DDS_MSECS(250));
  dds_qset_history(q, DDS_HISTORY_KEEP_LAST, 7);
  dds_qset_resource_limits(q, 100, 20, 10);
  dds_qset_latency_budget(q, DDS_MSECS(3));
  dds_qset_presentation(q, DDS_PRESENTATION_TOPIC, false, true);
  dds_qset_ownership(q, DDS_OWNERSHIP_EXCLUSIVE);
  const char* partitions[] = {"left", "r*"};
  dds_qset_partition(q, 2, partitions);
  dds_qset_groupdata(q, "group", 5);
  dds_qset_topicdata(q, "topic's", 7);
  dds_qset_liveliness(q, DDS_LIVELINESS_MANUAL_BY_TOPIC, DDS_SECS(20));
  dds_qset_ignorelocal(q, DDS_IGNORELOCAL_PROCESS);
  return q;
}

dds_entity_t RichTopic(const Process& self, const dds_qos_t* qos) {
  return OK(dds_create_topic(self.participant, &dds_test_Sample_desc, "a", qos, nullptr));
}

void Writer(Process& self) {
  dds_qos_t* q = Rich();
  dds_qset_lifespan(q, DDS_SECS(9));
  dds_qset_transport_priority(q, 4);
  dds_qset_ownership_strength(q, 11);
  const dds_entity_t publisher = OK(dds_create_publisher(self.participant, q, nullptr));
  const dds_entity_t rich = OK(dds_create_writer(publisher, RichTopic(self, q), q, nullptr));
  const dds_entity_t plain = self.Writer(self.Topic("b"), Qos());
  dds_delete_qos(q);
  WaitForReaders(rich, 1);
  WaitForReaders(plain, 1);
  self.peer.Meet("matched");
  const auto tell = [](const char* who, dds_entity_t writer) {
    dds_instance_handle_t handle;
    OK(dds_get_matched_subscriptions(writer, &handle, 1));
    TellOf(who, dds_get_matched_subscription_data(writer, handle));
  };
  tell("a reader", rich);
  tell("a plain reader", plain);
}

void Reader(Process& self) {
  dds_qos_t* q = Rich();
  dds_qset_time_based_filter(q, DDS_MSECS(1));
  const dds_entity_t subscriber = OK(dds_create_subscriber(self.participant, q, nullptr));
  const dds_entity_t rich = OK(dds_create_reader(subscriber, RichTopic(self, q), q, nullptr));
  const dds_entity_t plain = self.Reader(self.Topic("b"), Qos());
  dds_delete_qos(q);
  WaitForWriters(rich, 1);
  WaitForWriters(plain, 1);
  self.peer.Meet("matched");
  const auto tell = [](const char* who, dds_entity_t reader) {
    dds_instance_handle_t handle;
    OK(dds_get_matched_publications(reader, &handle, 1));
    TellOf(who, dds_get_matched_publication_data(reader, handle));
  };
  tell("a writer", rich);
  tell("a plain writer", plain);
}

}  // namespace

TCS_DDS_SCENARIO(seen_qos, Writer, Reader);
