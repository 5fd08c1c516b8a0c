// Two writers of one instance: it loses its writers only when both have unregistered it, or have
// gone.
#include "tests/dds/support/process.h"
#include "tests/dds/support/samples.h"

namespace {

using namespace dds_test;

void Writer(Process& self) {
  const dds_entity_t topic = self.Topic();
  const Qos qos = Qos().Reliable().KeepAll().UnregisterDoesNotDispose();
  const dds_entity_t first = self.Writer(topic, qos), second = self.Writer(topic, qos);
  WaitForReaders(first, 1);
  WaitForReaders(second, 1);
  self.peer.Meet("matched");
  const dds_test_Sample one{1, 0};
  Write(first, 1, 10);
  Write(first, 2, 20);
  Write(first, 90, 0);
  Write(second, 1, 11);
  Write(second, 2, 21);
  Write(second, 3, 30);
  Write(second, 91, 0);
  self.peer.Await("both told");
  OK(dds_unregister_instance(first, &one));
  Write(first, 92, 0);
  self.peer.Await("first unregistered");
  OK(dds_unregister_instance(second, &one));
  Write(second, 93, 0);
  self.peer.Await("second unregistered");
  OK(dds_delete(second));
  self.peer.Await("second gone");
  Write(first, 1, 12);
  Write(first, 94, 0);
  self.peer.Await("written again");
  OK(dds_delete(first));
}

void Reader(Process& self) {
  const dds_entity_t reader = self.Reader(self.Topic());
  WaitForWriters(reader, 2);
  self.peer.Meet("matched");
  WaitForSample<90>(reader);
  WaitForSample<91>(reader);
  Event("%zu samples of two writers", All(reader).size());
  self.peer.Reached("both told");
  WaitForSample<92>(reader);
  TakeAndTell(reader, "the first unregistered 1");
  self.peer.Reached("first unregistered");
  WaitForSample<93>(reader);
  TakeAndTell(reader, "the second unregistered 1");
  self.peer.Reached("second unregistered");
  WaitForWriters(reader, 1);
  TakeAndTell(reader, "the second has gone");
  self.peer.Reached("second gone");
  WaitForSample<94>(reader);
  TakeAndTell(reader, "the first wrote again");
  self.peer.Reached("written again");
  WaitForWriters(reader, 0);
  TakeAndTell(reader, "the first has gone");
}

}  // namespace

TCS_DDS_SCENARIO(several_writers_unregister, Writer, Reader);
