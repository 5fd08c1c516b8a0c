// A transient-local writer has written before the reader comes: the reader gets the two samples per
// instance that the writer keeps, and what is written later.
#include "tests/dds/support/process.h"
#include "tests/dds/support/samples.h"

namespace {

using namespace dds_test;

void Writer(Process& self) {
  const dds_entity_t writer =
      self.Writer(self.Topic(), Qos().Reliable().KeepAll().TransientLocal(2));
  for (int value = 1; value <= 5; value++) {
    Write(writer, 1, value);
    Write(writer, 2, 10 * value);
  }
  Write(writer, 90, 0);
  self.peer.Reached("written");
  self.peer.Await("history told");
  Write(writer, 1, 6);
  Write(writer, 91, 0);
}

void Reader(Process& self) {
  self.peer.Await("written");
  const dds_entity_t reader =
      self.Reader(self.Topic(), Qos().Reliable().KeepAll().TransientLocal());
  WaitForSample<90>(reader);
  TakeAndTell(reader, "history");
  self.peer.Reached("history told");
  WaitForSample<91>(reader);
  TakeAndTell(reader, "later");
}

}  // namespace

TCS_DDS_SCENARIO(late_reader, Writer, Reader);
