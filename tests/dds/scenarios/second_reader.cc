// A second transient-local reader, in a process that has one already: it gets the history, the
// first gets nothing twice, and both get what is written later.
#include "tests/dds/support/process.h"
#include "tests/dds/support/samples.h"

namespace {

using namespace dds_test;

void Writer(Process& self) {
  const dds_entity_t writer =
      self.Writer(self.Topic(), Qos().Reliable().KeepAll().TransientLocal());
  for (int value = 1; value <= 3; value++) Write(writer, 1, value);
  Write(writer, 90, 0);
  self.peer.Await("second is here");
  Write(writer, 1, 4);
  Write(writer, 91, 0);
}

void Reader(Process& self) {
  const dds_entity_t topic = self.Topic();
  const Qos qos = Qos().Reliable().KeepAll().TransientLocal();
  const dds_entity_t first = self.Reader(topic, qos);
  WaitForSample<90>(first);
  TakeAndTell(first, "first");
  const dds_entity_t second = self.Reader(topic, qos);
  WaitForSample<90>(second);
  self.peer.Reached("second is here");
  WaitForSample<91>(first);
  WaitForSample<91>(second);
  TakeAndTell(first, "first, later");
  TakeAndTell(second, "second");
}

}  // namespace

TCS_DDS_SCENARIO(second_reader, Writer, Reader);
