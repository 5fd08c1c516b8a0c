// Two types under one topic's name: writers and readers of the same type are matched, others not.
#include "tests/dds/support/process.h"
#include "tests/dds/support/samples.h"

namespace {

using namespace dds_test;

void Writer(Process& self) {
  const dds_entity_t samples = self.Writer(self.Topic("a"));
  const dds_entity_t blocks = self.Writer(self.Topic("a", &dds_test_Block_desc));
  WaitForReaders(samples, 1);
  WaitForReaders(blocks, 1);
  self.peer.Meet("matched");
  char name[] = "a block";
  const dds_test_Block block{name, {}};
  OK(dds_write(blocks, &block));
  Write(samples, 1, 1);
  Write(samples, 90, 0);
}

void Reader(Process& self) {
  const dds_entity_t samples = self.Reader(self.Topic("a"));
  const dds_entity_t blocks = self.Reader(self.Topic("a", &dds_test_Block_desc));
  WaitForWriters(samples, 1);
  WaitForWriters(blocks, 1);
  self.peer.Meet("matched");
  WaitForSample<90>(samples);
  TakeAndTell(samples, "samples");
  WaitForState(blocks, DDS_ANY_STATE);
  void* taken[2] = {};
  dds_sample_info_t infos[2];
  const int count = OK(dds_take(blocks, taken, infos, 2, 2));
  Event("blocks: %d, the first is '%s'", count, static_cast<dds_test_Block*>(taken[0])->name);
  OK(dds_return_loan(blocks, taken, count));
}

}  // namespace

TCS_DDS_SCENARIO(types, Writer, Reader);
