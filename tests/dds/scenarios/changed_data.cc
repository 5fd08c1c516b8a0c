// The user data of a participant, the data of a topic and those of a publisher change: others see
// what they are now, in another process as in another domain of the same program, and never what
// they were before that.
#include <stdlib.h>

#include <string>

#include "tests/dds/support/process.h"
#include "tests/dds/support/samples.h"

namespace {

using namespace dds_test;

constexpr int kChanges = 5;

Qos UserData(int value) { return Qos().UserData(std::to_string(value).c_str()); }

Qos TopicData(int value) {
  Qos qos;
  const std::string text = std::to_string(value);
  dds_qset_topicdata(const_cast<dds_qos_t*>(qos.get()), text.data(), text.size());
  return qos;
}

Qos GroupData(int value) {
  Qos qos;
  const std::string text = std::to_string(value);
  dds_qset_groupdata(const_cast<dds_qos_t*>(qos.get()), text.data(), text.size());
  return qos;
}

int ValueOf(const dds_qos_t* qos, bool (*get)(const dds_qos_t*, void**, std::size_t*)) {
  void* data = nullptr;
  std::size_t size = 0;
  if (!get(qos, &data, &size) || data == nullptr) return 0;
  const std::string text(static_cast<const char*>(data), size);
  dds_free(data);
  return atoi(text.c_str());
}

// Participants with user data, as a built-in topic shows them, one at a time.
class Participants {
 public:
  explicit Participants(dds_entity_t of)
      : reader_(
            OK(dds_create_reader(of, DDS_BUILTIN_TOPIC_DCPSPARTICIPANT, Plain().get(), nullptr))) {}

  // Waits until one has that value; fails if a value comes back.
  void WaitFor(int value) {
    WaitUntil("the user data change", [this, value] {
      void* sample = nullptr;
      dds_sample_info_t info;
      while (OK(dds_take(reader_, &sample, &info, 1, 1)) == 1) {
        const auto* shown = static_cast<const dds_builtintopic_participant_t*>(sample);
        const int now = info.valid_data ? ValueOf(shown->qos, dds_qget_userdata) : 0;
        OK(dds_return_loan(reader_, &sample, 1));
        if (now == 0) continue;
        if (now < last_) Fail("user data %d came after %d", now, last_);
        last_ = now;
      }
      return last_ == value;
    });
  }

 private:
  dds_entity_t reader_;
  int last_ = 0;
};

void Writer(Process& self) {
  self.DomainBeside("<Discovery><ExternalDomainId>" + std::to_string(self.domain) +
                    "</ExternalDomainId></Discovery>");
  const dds_entity_t topic =
      OK(dds_create_topic(self.participant, &dds_test_Sample_desc, "a", nullptr, nullptr));
  const dds_entity_t publisher = OK(dds_create_publisher(self.participant, nullptr, nullptr));
  const dds_entity_t writer = OK(dds_create_writer(publisher, topic, Plain().get(), nullptr));
  const dds_entity_t second = self.Writer(topic);
  Participants beside(self.Participant(1));
  WaitForReaders(writer, 1);
  WaitForReaders(second, 1);
  self.peer.Meet("matched");
  for (int value = 1; value <= kChanges; value++) {
    OK(dds_set_qos(topic, TopicData(value).get()));
    OK(dds_set_qos(publisher, GroupData(value).get()));
    OK(dds_set_qos(self.participant, UserData(value).get()));
    self.Topic("b");
    if (value % 2 == 0) continue;
    beside.WaitFor(value);
    self.peer.Await("seen");
  }
  self.peer.Meet("told");
}

int ValueOfWriter(dds_entity_t reader, dds_instance_handle_t writer,
                  bool (*get)(const dds_qos_t*, void**, std::size_t*)) {
  dds_builtintopic_endpoint_t* shown = dds_get_matched_publication_data(reader, writer);
  if (shown == nullptr) return 0;
  const int value = ValueOf(shown->qos, get);
  dds_builtintopic_free_endpoint(shown);
  return value;
}

void Reader(Process& self) {
  const dds_entity_t reader = self.Reader(self.Topic());
  Participants participants(self.participant);
  WaitForWriters(reader, 2);
  dds_instance_handle_t writers[2];
  OK(dds_get_matched_publications(reader, writers, 2));
  self.peer.Meet("matched");
  for (int value = 1; value <= kChanges; value += 2) {
    participants.WaitFor(value);
    WaitUntil("the topic's data change", [&] {
      return ValueOfWriter(reader, writers[0], dds_qget_topicdata) == value &&
             ValueOfWriter(reader, writers[1], dds_qget_topicdata) == value;
    });
    // One of the two is of the publisher.
    WaitUntil("the publisher's data change", [&] {
      return ValueOfWriter(reader, writers[0], dds_qget_groupdata) +
                 ValueOfWriter(reader, writers[1], dds_qget_groupdata) ==
             value;
    });
    Event("%d", value);
    self.peer.Reached("seen");
  }
  self.peer.Meet("told");
}

}  // namespace

TCS_DDS_SCENARIO(changed_data, Writer, Reader);
