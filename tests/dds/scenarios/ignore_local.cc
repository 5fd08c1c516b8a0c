// Readers that ignore what is local, to their participant or to their process, still get everything
// from the other process.
#include "tests/dds/support/process.h"
#include "tests/dds/support/samples.h"

namespace {

using namespace dds_test;

// Both processes do the same, each with a key of its own.
void Play(Process& self, int key) {
  const dds_entity_t topic = self.Topic();
  const dds_entity_t other = self.Participant();
  const dds_entity_t other_topic =
      OK(dds_create_topic(other, &dds_test_Sample_desc, "a", nullptr, nullptr));
  const auto ignoring = [](dds_entity_t participant, dds_entity_t in, dds_ignorelocal_kind_t kind) {
    return OK(dds_create_reader(participant, in, Qos().Reliable().KeepAll().IgnoreLocal(kind).get(),
                                nullptr));
  };
  struct {
    const char* name;
    dds_entity_t reader;
    std::uint32_t writers;
  } const readers[] = {
      {"nothing ignored", self.Reader(topic), 2},
      {"participant ignored", ignoring(self.participant, topic, DDS_IGNORELOCAL_PARTICIPANT), 1},
      {"process ignored", ignoring(self.participant, topic, DDS_IGNORELOCAL_PROCESS), 1},
      {"other participant, participant ignored",
       ignoring(other, other_topic, DDS_IGNORELOCAL_PARTICIPANT), 2},
      {"other participant, process ignored", ignoring(other, other_topic, DDS_IGNORELOCAL_PROCESS),
       1},
  };
  const dds_entity_t writer = self.Writer(topic);
  for (const auto& r : readers) WaitForWriters(r.reader, r.writers);
  WaitForReaders(writer, 3 + 5 - 1);
  self.peer.Meet("matched");
  Write(writer, key, 10 * key);
  Write(writer, 90 + key, 0);
  for (const auto& r : readers) {
    key == 1 ? WaitForSample<92>(r.reader) : WaitForSample<91>(r.reader);
    if (r.writers == 2) key == 1 ? WaitForSample<91>(r.reader) : WaitForSample<92>(r.reader);
    TakeAndTell(r.reader, r.name);
  }
  self.peer.Meet("told");
  OK(dds_delete(other));
}

void Writer(Process& self) { Play(self, 1); }
void Reader(Process& self) { Play(self, 2); }

}  // namespace

TCS_DDS_SCENARIO(ignore_local, Writer, Reader);
