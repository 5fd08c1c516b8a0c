// What a late transient-local reader gets of instances that were disposed or unregistered before it
// came, and of a writer that has gone.
#include "tests/dds/support/process.h"
#include "tests/dds/support/samples.h"

namespace {

using namespace dds_test;

void Writer(Process& self) {
  const dds_entity_t topic = self.Topic();
  const Qos qos = Plain().TransientLocal().UnregisterDoesNotDispose();
  const dds_entity_t writer = self.Writer(topic, qos), gone = self.Writer(topic, qos);
  const dds_test_Sample two{2, 0}, three{3, 0};
  for (int key = 1; key <= 3; key++) Write(writer, key, 10 * key);
  Write(gone, 4, 40);
  OK(dds_dispose(writer, &two));
  OK(dds_unregister_instance(writer, &three));
  OK(dds_delete(gone));
  Write(writer, 90, 0);
  self.peer.Reached("written");
}

void Reader(Process& self) {
  self.peer.Await("written");
  const dds_entity_t reader = self.Reader(self.Topic(), Plain().TransientLocal());
  WaitForSample<90>(reader);
  TakeAndTell(reader, "late reader");
}

}  // namespace

TCS_DDS_SCENARIO(late_reader_after_dispose, Writer, Reader);
