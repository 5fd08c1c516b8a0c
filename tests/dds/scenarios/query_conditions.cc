// Query conditions select by value, as well as by state; two of one reader share its samples.
#include "tests/dds/support/process.h"
#include "tests/dds/support/samples.h"

namespace {

using namespace dds_test;

void Writer(Process& self) {
  const dds_entity_t writer = self.Writer(self.Topic());
  WaitForReaders(writer, 1);
  self.peer.Meet("matched");
  for (int value = 1; value <= 3; value++) {
    Write(writer, 1, value);
    Write(writer, 2, 10 * value);
  }
  Write(writer, 90, 0);
  self.peer.Await("taken");
  Write(writer, 3, 25);
}

bool AboveTen(const void* sample) {
  return static_cast<const dds_test_Sample*>(sample)->value > 10;
}
bool Even(const void* sample) {
  return static_cast<const dds_test_Sample*>(sample)->value % 2 == 0;
}

void Reader(Process& self) {
  const dds_entity_t reader = self.Reader(self.Topic());
  const dds_entity_t large = OK(dds_create_querycondition(reader, DDS_ANY_STATE, AboveTen));
  const dds_entity_t even = OK(dds_create_querycondition(
      reader, DDS_NOT_READ_SAMPLE_STATE | DDS_ANY_VIEW_STATE | DDS_ANY_INSTANCE_STATE, Even));
  Event("empty: %d %d", OK(dds_triggered(large)), OK(dds_triggered(even)));
  WaitForWriters(reader, 1);
  self.peer.Meet("matched");
  WaitForSample<90>(reader);
  Event("written: %d %d", OK(dds_triggered(large)), OK(dds_triggered(even)));
  Tell("even and not read", All(even, How::kRead));
  Tell("even and not read, again", All(even, How::kRead));
  Tell("above ten", All(large));
  Event("taken: %d %d", OK(dds_triggered(large)), OK(dds_triggered(even)));
  Tell("what is left", All(reader));
  self.peer.Reached("taken");
  WaitForTrigger(large);
  Event("25 came: %d %d", OK(dds_triggered(large)), OK(dds_triggered(even)));
  TakeAndTell(reader, "above ten");
}

}  // namespace

TCS_DDS_SCENARIO(query_conditions, Writer, Reader);
