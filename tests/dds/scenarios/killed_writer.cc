// A writer's process is killed: when its lease is over the reader sees the writer not alive, and
// its instance disposed (it was its only writer), and keeps the sample. Another writer goes on as
// before.
#include <signal.h>

#include "tests/dds/support/process.h"
#include "tests/dds/support/samples.h"

namespace {

using namespace dds_test;

constexpr dds_duration_t kLease = DDS_MSECS(500);

void Writer(Process& self) {
  const dds_entity_t writer = self.Writer(self.Topic(), Leased(kLease));
  WaitForReaders(writer, 1);
  self.peer.Meet("matched");
  Write(writer, 1, 1);
  self.peer.Await("received");
  Event("killed");
  raise(SIGKILL);
}

void Reader(Process& self) {
  const dds_entity_t topic = self.Topic();
  const Qos qos = Leased(kLease);
  const dds_entity_t reader = self.Reader(topic, qos);
  WaitForWriters(reader, 1);
  self.peer.Meet("matched");
  WaitForSample<1>(reader);
  const dds_entity_t own = self.Writer(topic, qos);
  WaitForWriters(reader, 2);
  Write(own, 2, 1);
  WaitForSample<2>(reader);
  self.peer.Reached("received");
  WaitForState(reader, kNotAlive);
  WaitForLiveWriters(reader, 1);
  Event("one writer is alive");
  TakeAndTell(reader, "reader");
  Write(own, 2, 2);
  WaitForSample<2>(reader);
  TakeAndTell(reader, "later");
}

}  // namespace

TCS_DDS_SCENARIO(killed_writer, Writer, Reader, ::dds_test::End::kWriterKilled);
