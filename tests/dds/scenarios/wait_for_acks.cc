// dds_wait_for_acks returns when the readers have everything, at once if there are none, and
// refuses readers.
#include "tests/dds/support/process.h"
#include "tests/dds/support/samples.h"

namespace {

using namespace dds_test;

void Writer(Process& self) {
  const dds_entity_t topic = self.Topic();
  const dds_entity_t unheard = self.Writer(self.Topic("b"));
  Write(unheard, 1, 1);
  Event("without readers: %s", Code(dds_wait_for_acks(unheard, kPatience)));
  const dds_entity_t own_reader = self.Reader(self.Topic("c"));
  Event("of a reader: %s", Code(dds_wait_for_acks(own_reader, kPatience)));

  const dds_entity_t writer = self.Writer(topic);
  WaitForReaders(writer, 2);
  self.peer.Meet("matched");
  for (int value = 1; value <= 50; value++) Write(writer, 1, value);
  Event("with readers: %s", Code(dds_wait_for_acks(writer, kPatience)));
  Write(writer, 90, 0);
  self.peer.Reached("acknowledged");
}

void Reader(Process& self) {
  const dds_entity_t topic = self.Topic();
  const dds_entity_t first = self.Reader(topic), second = self.Reader(topic);
  WaitForWriters(first, 1);
  WaitForWriters(second, 1);
  self.peer.Meet("matched");
  self.peer.Await("acknowledged");
  WaitForSample<90>(first);
  WaitForSample<90>(second);
  Event("%zu and %zu samples", All(first).size() - 1, All(second).size() - 1);
}

}  // namespace

TCS_DDS_SCENARIO(wait_for_acks, Writer, Reader);
