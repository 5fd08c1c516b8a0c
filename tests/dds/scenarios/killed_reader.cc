// A reliable writer waits without a limit for a full reader, whose program is killed: the write
// ends when the lease of that program is over, and the writer has no reader any more.
#include <signal.h>
#include <stdio.h>

#include <algorithm>
#include <vector>

#include "tests/dds/support/process.h"
#include "tests/dds/support/waits.h"

namespace {

using namespace dds_test;

constexpr std::uint32_t kBytes = 20'000;

dds_entity_t ShortLived(Process& self) {
  self.UseShortLease("2s");
  return self.Topic("block", &dds_test_Block_desc);
}

void Writer(Process& self) {
  const dds_entity_t writer = self.Writer(ShortLived(self));
  WaitForReaders(writer, 1);
  self.peer.Meet("matched");
  std::vector<std::uint8_t> bytes(kBytes);
  char name[] = "block";
  dds_test_Block block{name, {kBytes, kBytes, bytes.data(), false}};
  dds_duration_t longest = 0;
  dds_publication_matched_status_t status;
  do {
    const dds_time_t start = dds_time();
    OK(dds_write(writer, &block));
    longest = std::max(longest, dds_time() - start);
    OK(dds_get_publication_matched_status(writer, &status));
  } while (status.current_count > 0);
  Event("a write waited: %s", longest > DDS_MSECS(500) ? "yes" : "no");
  Event("readers: %u", status.current_count);
}

void Reader(Process& self) {
  const dds_entity_t reader = self.Reader(ShortLived(self), Plain().AtMost(10));
  WaitForWriters(reader, 1);
  self.peer.Meet("matched");
  dds_sleepfor(DDS_MSECS(300));
  Event("killed");
  raise(SIGKILL);
}

}  // namespace

TCS_DDS_SCENARIO(killed_reader, Writer, Reader, ::dds_test::End::kReaderKilled);
