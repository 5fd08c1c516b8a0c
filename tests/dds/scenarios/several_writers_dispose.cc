// Two writers of one instance, one of which disposes it: it is not alive until the other one writes
// again. Nothing of this touches the other instances.
#include "tests/dds/support/process.h"
#include "tests/dds/support/samples.h"

namespace {

using namespace dds_test;

void Writer(Process& self) {
  const dds_entity_t topic = self.Topic();
  const dds_entity_t first = self.Writer(topic), second = self.Writer(topic);
  WaitForReaders(first, 1);
  WaitForReaders(second, 1);
  self.peer.Meet("matched");
  Write(first, 1, 10);
  Write(first, 2, 20);
  Write(first, 90, 0);
  self.peer.Await("first told");
  Write(second, 1, 11);
  Write(second, 3, 30);
  Write(second, 91, 0);
  self.peer.Await("second told");
  const dds_test_Sample one{1, 0}, two{2, 21};
  OK(dds_dispose(first, &one));
  OK(dds_writedispose(first, &two));
  Write(first, 92, 0);
  self.peer.Await("dispose told");
  Write(second, 1, 12);
  Write(second, 93, 0);
}

void Reader(Process& self) {
  const dds_entity_t reader = self.Reader(self.Topic());
  WaitForWriters(reader, 2);
  self.peer.Meet("matched");
  WaitForSample<90>(reader);
  TakeAndTell(reader, "the first wrote");
  self.peer.Reached("first told");
  WaitForSample<91>(reader);
  TakeAndTell(reader, "the second wrote");
  self.peer.Reached("second told");
  WaitForSample<92>(reader);
  TakeAndTell(reader, "the first disposed");
  self.peer.Reached("dispose told");
  WaitForSample<93>(reader);
  TakeAndTell(reader, "the second wrote again");
}

}  // namespace

TCS_DDS_SCENARIO(several_writers_dispose, Writer, Reader);
