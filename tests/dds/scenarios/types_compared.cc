// Types of one topic are compared as XTypes says, whatever they are called: a reader gets what is
// assignable to its type, in its own form, and does not match what is not.
#include <dds/dds.h>

#include "evolved.h"
#include "tests/dds/support/process.h"
#include "tests/dds/support/waits.h"

namespace {

using namespace dds_test;

Qos Lasting() { return Plain().TransientLocal(); }

void Write(dds_entity_t writer, const auto& sample) { OK(dds_write(writer, &sample)); }

dds_entity_t WriterOf(Process& self, const char* topic, const dds_topic_descriptor_t& type) {
  return self.Writer(self.Topic(topic, &type), Lasting());
}

// Late ones get the history, early ones what is written then.
void Writer(Process& self) {
  const dds_entity_t a = WriterOf(self, "a", dds_evolved_Old_desc);
  const dds_entity_t b = WriterOf(self, "b", dds_evolved_New_desc);
  const dds_entity_t c = WriterOf(self, "c", dds_evolved_OldMutable_desc);
  const dds_entity_t d = WriterOf(self, "d", dds_evolved_NewMutable_desc);
  const dds_entity_t other = WriterOf(self, "e", dds_evolved_Other_desc);
  const dds_entity_t strict = WriterOf(self, "f", dds_evolved_Old_desc);
  char more[] = "more";
  const auto write_all = [&](int key) {
    Write(a, dds_evolved_Old{key, 10});
    Write(b, dds_evolved_New{key, 20, 21});
    Write(c, dds_evolved_OldMutable{key, 30});
    Write(d, dds_evolved_NewMutable{more, key, 40});
    Write(strict, dds_evolved_Old{key, 60});
  };
  write_all(1);
  self.peer.Meet("written");
  WaitForReaders(a, 3);
  for (const dds_entity_t writer : {b, c, d}) WaitForReaders(writer, 2);
  self.peer.Meet("matched");
  write_all(2);
  const dds_evolved_New gone{1, 0, 0};
  OK(dds_dispose(b, &gone));
  self.peer.Meet("done");
  dds_offered_incompatible_qos_status_t status;
  for (const dds_entity_t writer : {other, strict}) {
    WaitUntil("all is told", [&] {
      OK(dds_get_offered_incompatible_qos_status(writer, &status));
      return status.total_count > 0;
    });
    dds_publication_matched_status_t matched;
    OK(dds_get_publication_matched_status(writer, &matched));
    Event("unsuitable: %u readers, %u matched, the last for policy %u", status.total_count,
          matched.total_count, status.last_policy_id);
  }
}

template <class Sample>
void Take(dds_entity_t reader, const char* who, int count,
          void (*tell)(const char*, const Sample&)) {
  WaitUntil("all is there", [&] {
    void* samples[8] = {};
    dds_sample_info_t infos[8];
    const int found = OK(dds_read(reader, samples, infos, 8, 8));
    if (found > 0) OK(dds_return_loan(reader, samples, found));
    return found == count;
  });
  void* samples[8] = {};
  dds_sample_info_t infos[8];
  const int found = OK(dds_take(reader, samples, infos, 8, 8));
  for (int i = 0; i < found; i++) {
    if (infos[i].valid_data) tell(who, *static_cast<const Sample*>(samples[i]));
    if (infos[i].instance_state != DDS_IST_ALIVE) Event("%s: not alive", who);
  }
  OK(dds_return_loan(reader, samples, found));
}

void TellOld(const char* who, const dds_evolved_Old& s) {
  Event("%s: %d: %d", who, s.key, s.value);
}
void TellNew(const char* who, const dds_evolved_New& s) {
  Event("%s: %d: %d and %d", who, s.key, s.value, s.more);
}
void TellOldMutable(const char* who, const dds_evolved_OldMutable& s) {
  Event("%s: %d: %d", who, s.key, s.value);
}
void TellNewMutable(const char* who, const dds_evolved_NewMutable& s) {
  Event("%s: %d: %d and '%s'", who, s.key, s.value, s.more == nullptr ? "" : s.more);
}

struct Readers {
  dds_entity_t a, b, c, d;

  explicit Readers(Process& self)
      : a(Of(self, "a", dds_evolved_New_desc)),
        b(Of(self, "b", dds_evolved_Old_desc)),
        c(Of(self, "c", dds_evolved_NewMutable_desc)),
        d(Of(self, "d", dds_evolved_OldMutable_desc)) {}
  static dds_entity_t Of(Process& self, const char* topic, const dds_topic_descriptor_t& type) {
    return self.Reader(self.Topic(topic, &type), Lasting());
  }
  void TakeAll(int count_of_b) {
    for (const dds_entity_t reader : {a, b, c, d}) WaitForWriters(reader, 1);
    Take<dds_evolved_New>(a, "new from old", 1, TellNew);
    Take<dds_evolved_Old>(b, "old from new", count_of_b, TellOld);
    Take<dds_evolved_NewMutable>(c, "mutable, new from old", 1, TellNewMutable);
    Take<dds_evolved_OldMutable>(d, "mutable, old from new", 1, TellOldMutable);
  }
};

void Reader(Process& self) {
  Readers early(self);
  // Two types in one process, each of whose readers gets a sample once.
  const dds_entity_t beside = Readers::Of(self, "a", dds_evolved_Old_desc);
  const dds_entity_t other = Readers::Of(self, "e", dds_evolved_Old_desc);
  dds_qos_t* qos = dds_create_qos();
  dds_copy_qos(qos, Lasting().get());
  dds_qset_type_consistency(qos, DDS_TYPE_CONSISTENCY_DISALLOW_TYPE_COERCION, false, false, false,
                            false, false);
  const dds_entity_t strict =
      OK(dds_create_reader(self.participant, self.Topic("f", &dds_evolved_New_desc), qos, nullptr));
  dds_delete_qos(qos);
  self.peer.Meet("written");
  early.TakeAll(1);
  Take<dds_evolved_Old>(beside, "old beside it", 1, TellOld);
  Readers late(self);
  late.TakeAll(1);
  self.peer.Meet("matched");
  early.TakeAll(2);
  Take<dds_evolved_Old>(beside, "old beside it", 1, TellOld);
  for (const dds_entity_t reader : {other, strict}) {
    dds_requested_incompatible_qos_status_t status;
    // Types are asked for one by one, and may come in any order.
    WaitUntil("all is told", [&] {
      OK(dds_get_requested_incompatible_qos_status(reader, &status));
      return status.total_count > 0;
    });
    dds_subscription_matched_status_t matched;
    OK(dds_get_subscription_matched_status(reader, &matched));
    Event("unsuitable: %u writers, %u matched, the last for policy %u", status.total_count,
          matched.total_count, status.last_policy_id);
  }
  self.peer.Meet("done");
}

}  // namespace

TCS_DDS_SCENARIO(types_compared, Writer, Reader);
