// Partitions set on publishers and subscribers, one of them with a wildcard: who shares one is
// matched.
#include "tests/dds/support/process.h"
#include "tests/dds/support/samples.h"

namespace {

using namespace dds_test;

dds_entity_t WriterIn(const Process& self, const char* partition) {
  const dds_entity_t publisher =
      OK(dds_create_publisher(self.participant, Qos().Partition(partition).get(), nullptr));
  return OK(dds_create_writer(publisher, self.Topic(), Plain().get(), nullptr));
}

dds_entity_t ReaderIn(const Process& self, const char* partition) {
  const dds_entity_t subscriber =
      OK(dds_create_subscriber(self.participant, Qos().Partition(partition).get(), nullptr));
  return OK(dds_create_reader(subscriber, self.Topic(), Plain().get(), nullptr));
}

void Writer(Process& self) {
  const dds_entity_t left = WriterIn(self, "robot/left"), right = WriterIn(self, "robot/right"),
                     none = self.Writer(self.Topic());
  WaitForReaders(left, 2);
  WaitForReaders(right, 1);
  WaitForReaders(none, 1);
  self.peer.Meet("matched");
  const struct {
    dds_entity_t writer;
    int key;
  } writers[] = {{left, 1}, {right, 2}, {none, 3}};
  for (const auto& w : writers) {
    Write(w.writer, w.key, 1);
    Write(w.writer, 90 + w.key, 0);
  }
}

void Reader(Process& self) {
  const dds_entity_t left = ReaderIn(self, "robot/left"), all = ReaderIn(self, "robot/*"),
                     other = ReaderIn(self, "other"), none = self.Reader(self.Topic());
  WaitForWriters(left, 1);
  WaitForWriters(all, 2);
  WaitForWriters(none, 1);
  self.peer.Meet("matched");
  WaitForSample<91>(left);
  WaitForSample<91>(all);
  WaitForSample<92>(all);
  WaitForSample<93>(none);
  TakeAndTell(left, "robot/left");
  TakeAndTell(all, "robot/*");
  TakeAndTell(other, "other");
  TakeAndTell(none, "no partition");
}

}  // namespace

TCS_DDS_SCENARIO(partitions, Writer, Reader);
