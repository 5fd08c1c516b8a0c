// Exclusive ownership: only the strongest writer of an instance is heard, until it has gone.
#include "tests/dds/support/process.h"
#include "tests/dds/support/samples.h"

namespace {

using namespace dds_test;

void Writer(Process& self) {
  const dds_entity_t topic = self.Topic();
  const dds_entity_t weak = self.Writer(topic, Plain().Exclusive(1)),
                     strong = self.Writer(topic, Plain().Exclusive(2));
  WaitForReaders(weak, 1);
  WaitForReaders(strong, 1);
  self.peer.Meet("matched");
  Write(weak, 1, 1);
  Write(weak, 90, 0);
  self.peer.Await("the weak one alone");
  Write(strong, 1, 2);
  Write(strong, 91, 0);
  self.peer.Await("the strong one");
  Write(weak, 1, 3);
  Write(weak, 2, 4);
  Write(weak, 92, 0);
  self.peer.Await("the weak one beside it");
  OK(dds_delete(strong));
  self.peer.Await("the strong one has gone");
  Write(weak, 1, 5);
  Write(weak, 93, 0);
}

void Reader(Process& self) {
  const dds_entity_t reader = self.Reader(self.Topic(), Plain().Exclusive());
  WaitForWriters(reader, 2);
  self.peer.Meet("matched");
  const auto told = [&](const char* what) {
    TakeAndTell(reader, what);
    self.peer.Reached(what);
  };
  WaitForSample<90>(reader);
  told("the weak one alone");
  WaitForSample<91>(reader);
  told("the strong one");
  WaitForSample<92>(reader);
  told("the weak one beside it");
  WaitForWriters(reader, 1);
  told("the strong one has gone");
  WaitForSample<93>(reader);
  TakeAndTell(reader, "the weak one again");
}

}  // namespace

TCS_DDS_SCENARIO(ownership, Writer, Reader);
