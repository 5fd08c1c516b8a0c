// A writer's program ends without deleting anything: when its lease is over the reader sees the
// writer not alive and its instance without writers, and keeps the sample.
#include <stdlib.h>

#include "tests/dds/support/process.h"
#include "tests/dds/support/samples.h"

namespace {

using namespace dds_test;

constexpr dds_duration_t kLease = DDS_MSECS(500);

void Writer(Process& self) {
  const dds_entity_t writer = self.Writer(self.Topic(), Leased(kLease).UnregisterDoesNotDispose());
  WaitForReaders(writer, 1);
  self.peer.Meet("matched");
  Write(writer, 1, 1);
  self.peer.Await("received");
  Event("exits");
  exit(0);
}

void Reader(Process& self) {
  const dds_entity_t reader = self.Reader(self.Topic(), Leased(kLease));
  WaitForWriters(reader, 1);
  self.peer.Meet("matched");
  WaitForSample<1>(reader);
  self.peer.Reached("received");
  WaitForState(reader, kNotAlive);
  WaitForLiveWriters(reader, 0);
  Event("no writer is alive");
  TakeAndTell(reader, "reader");
}

}  // namespace

TCS_DDS_SCENARIO(exited_writer, Writer, Reader, ::dds_test::End::kWriterExits);
