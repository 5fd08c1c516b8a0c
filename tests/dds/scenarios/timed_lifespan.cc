// A sample is there until its lifespan is over, and not after it. Cyclone counts it from the
// sample's arrival, which is the write where samples are carried exactly.
#include "tests/dds/support/process.h"
#include "tests/dds/support/samples.h"
#include "tests/dds/support/timing.h"

namespace {

using namespace dds_test;

constexpr dds_duration_t kLifespan = DDS_MSECS(300);

void Writer(Process& self) {
  const dds_entity_t writer =
      self.Writer(self.Topic(), Qos().Reliable().KeepAll().Lifespan(kLifespan));
  WaitForReaders(writer, 1);
  self.peer.Meet("matched");
  Write(writer, 1, 1);
}

void Reader(Process& self) {
  const dds_entity_t reader = self.Reader(self.Topic());
  WaitForWriters(reader, 1);
  self.peer.Meet("matched");
  WaitForSample<1>(reader);
  const dds_time_t written = All(reader, How::kRead).at(0).info.source_timestamp;
  while (!All(reader, How::kRead).empty()) dds_sleepfor(DDS_USECS(200));
  const dds_time_t gone = dds_time();
  CheckDue(self, "the end of a lifespan", gone, written + kLifespan);
  Event("the sample was there for its lifespan");
}

}  // namespace

TCS_DDS_SCENARIO(timed_lifespan, Writer, Reader);
