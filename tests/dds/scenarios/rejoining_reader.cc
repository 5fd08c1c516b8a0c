// A transient-local reader goes and comes back, first alone, then with its participant: each time
// it gets the whole history, and what was written in its absence with it.
#include "tests/dds/support/process.h"
#include "tests/dds/support/samples.h"

namespace {

using namespace dds_test;

void Writer(Process& self) {
  const dds_entity_t writer =
      self.Writer(self.Topic(), Qos().Reliable().KeepAll().TransientLocal());
  Write(writer, 1, 1);
  Write(writer, 90, 0);
  WaitForReaders(writer, 1);
  self.peer.Reached("matched");
  self.peer.Await("reader gone");
  WaitForReaders(writer, 0);
  Event("the reader has gone");
  Write(writer, 1, 2);
  Write(writer, 91, 0);
  self.peer.Reached("written again");
  WaitForReaders(writer, 1);
  self.peer.Reached("matched");
  self.peer.Await("participant gone");
  WaitForReaders(writer, 0);
  Event("the participant has gone");
  Write(writer, 1, 3);
  Write(writer, 92, 0);
  self.peer.Reached("written a third time");
}

template <int marker>
dds_entity_t Join(Process& self, const char* who) {
  const dds_entity_t reader =
      self.Reader(self.Topic(), Qos().Reliable().KeepAll().TransientLocal());
  WaitForSample<marker>(reader);
  WaitForWriters(reader, 1);
  TakeAndTell(reader, who);
  return reader;
}

void Reader(Process& self) {
  const dds_entity_t reader = Join<90>(self, "at first");
  self.peer.Await("matched");
  OK(dds_delete(reader));
  self.peer.Reached("reader gone");
  self.peer.Await("written again");
  Join<91>(self, "back");
  self.peer.Await("matched");
  OK(dds_delete(self.participant));
  self.peer.Reached("participant gone");
  self.peer.Await("written a third time");
  self.participant = self.Participant();
  Join<92>(self, "with a new participant");
}

}  // namespace

TCS_DDS_SCENARIO(rejoining_reader, Writer, Reader);
