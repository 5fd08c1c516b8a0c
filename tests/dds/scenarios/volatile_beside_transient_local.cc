// Of two readers that come late only the transient-local one gets the history; the volatile one
// beside it gets nothing that was written before it was matched.
#include "tests/dds/support/process.h"
#include "tests/dds/support/samples.h"

namespace {

using namespace dds_test;

void Writer(Process& self) {
  const dds_entity_t writer =
      self.Writer(self.Topic(), Qos().Reliable().KeepAll().TransientLocal());
  for (int value = 1; value <= 3; value++) Write(writer, 1, value);
  Write(writer, 90, 0);
  self.peer.Reached("written");
  self.peer.Await("matched");
  WaitForReaders(writer, 2);
  Write(writer, 1, 4);
  Write(writer, 91, 0);
  self.peer.Await("late one matched");
  WaitForReaders(writer, 3);
  Write(writer, 1, 5);
  Write(writer, 92, 0);
}

void Reader(Process& self) {
  self.peer.Await("written");
  const dds_entity_t topic = self.Topic();
  const dds_entity_t forgetful = self.Reader(topic, Plain());
  const dds_entity_t keeping = self.Reader(topic, Qos().Reliable().KeepAll().TransientLocal());
  WaitForWriters(forgetful, 1);
  WaitForWriters(keeping, 1);
  WaitForSample<90>(keeping);
  self.peer.Reached("matched");
  WaitForSample<91>(keeping);
  WaitForSample<91>(forgetful);
  TakeAndTell(keeping, "transient-local");
  TakeAndTell(forgetful, "volatile");

  // The catching-up of a late transient-local reader reaches nobody else.
  const dds_entity_t late = self.Reader(topic, Qos().Reliable().KeepAll().TransientLocal());
  WaitForSample<91>(late);
  self.peer.Reached("late one matched");
  for (const dds_entity_t reader : {forgetful, keeping, late}) WaitForSample<92>(reader);
  TakeAndTell(late, "late transient-local");
  TakeAndTell(keeping, "transient-local");
  TakeAndTell(forgetful, "volatile");
}

}  // namespace

TCS_DDS_SCENARIO(volatile_beside_transient_local, Writer, Reader);
