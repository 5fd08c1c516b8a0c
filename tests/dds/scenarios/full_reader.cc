// A reliable reader that keeps all it gets has as many samples as it may have, and its program does
// not take any: after a while a write of the reliable writer gives up when max_blocking_time is
// over. All writes that did not give up arrive once the program takes them, in their order, and the
// writer can go on. A full reader can be deleted, where samples are in shared memory.
#include <string>
#include <vector>

#include "tests/dds/support/process.h"
#include "tests/dds/support/samples.h"
#include "tests/dds/support/timing.h"

namespace {

using namespace dds_test;

constexpr dds_duration_t kMostBlocking = DDS_MSECS(200);
constexpr int kMostSamples = 10;
constexpr std::uint32_t kBytes = 20'000;

dds_return_t WriteBlock(dds_entity_t writer, int number, std::uint32_t size = kBytes) {
  std::vector<std::uint8_t> bytes(size);
  std::string name = std::to_string(number);
  dds_test_Block block{name.data(), {size, size, bytes.data(), false}};
  return dds_write(writer, &block);
}

void Writer(Process& self) {
  const dds_entity_t writer = self.Writer(self.Topic("block", &dds_test_Block_desc),
                                          Qos().Reliable(kMostBlocking).KeepAll());
  WaitForReaders(writer, 1);
  self.peer.Meet("matched");
  int written = 0;
  dds_time_t start = dds_time();
  dds_return_t result;
  while ((result = WriteBlock(writer, written)) == DDS_RETCODE_OK) {
    if (++written == 100'000) Fail("the writer never waits");
    start = dds_time();
  }
  CheckDue(self, "the write's end", dds_time(), start + kMostBlocking);
  Event("a write that waits: %s", Code(result));
  self.peer.Send(written);
  self.peer.Await("taken");
  Event("and one later: %s", Code(WriteBlock(writer, written)));
  self.peer.Await("taken again");
  for (int i = 0; i < kMostSamples + 5; i++) OK(WriteBlock(writer, i, 10));
  self.peer.Reached("full");
  self.peer.Meet("deleted");
  WaitForReaders(writer, 0);
}

int NumberOfNext(dds_entity_t reader) {
  WaitForState(reader, DDS_ANY_STATE);
  void* samples[1] = {};
  dds_sample_info_t info;
  if (OK(dds_take(reader, samples, &info, 1, 1)) != 1) Fail("there is no sample");
  const int number = atoi(static_cast<const dds_test_Block*>(samples[0])->name);
  OK(dds_return_loan(reader, samples, 1));
  return number;
}

void Reader(Process& self) {
  const dds_entity_t reader =
      self.Reader(self.Topic("block", &dds_test_Block_desc), Plain().AtMost(kMostSamples));
  WaitForWriters(reader, 1);
  self.peer.Meet("matched");
  const int written = self.peer.Receive<int>();
  for (int i = 0; i < written; i++) {
    if (const int number = NumberOfNext(reader); number != i)
      Fail("%d came in place of %d", number, i);
  }
  Event("all that was written came");
  self.peer.Reached("taken");
  if (NumberOfNext(reader) != written) Fail("another came in place of the last");
  Event("and the later one");
  self.peer.Reached("taken again");
  self.peer.Await("full");
  dds_sleepfor(DDS_MSECS(50));
  // Over a network Cyclone's receiving thread would hold on to a full reader for ever.
  for (int i = 0; self.under != Under::kEndpoints && i < kMostSamples + 5; i++)
    NumberOfNext(reader);
  OK(dds_delete(reader));
  Event("the reader was deleted");
  self.peer.Meet("deleted");
}

}  // namespace

TCS_DDS_SCENARIO(full_reader, Writer, Reader);
