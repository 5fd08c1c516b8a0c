// A program with readers is stopped by a signal. A reliable writer that keeps all waits for it, for
// its max_blocking_time; one that keeps the last does not wait at all. When the program goes on it
// gets all of the one, and the last of the other.
#include <signal.h>
#include <unistd.h>

#include <string>
#include <vector>

#include "tests/dds/support/process.h"
#include "tests/dds/support/samples.h"
#include "tests/dds/support/timing.h"

namespace {

using namespace dds_test;

constexpr dds_duration_t kMostBlocking = DDS_MSECS(200);
constexpr std::uint32_t kBytes = 20'000;
constexpr int kStates = 20'000;

void Writer(Process& self) {
  const dds_entity_t events = self.Writer(self.Topic("block", &dds_test_Block_desc),
                                          Qos().Reliable(kMostBlocking).KeepAll());
  const dds_entity_t states = self.Writer(self.Topic(), Qos().Reliable(0).KeepLast(1));
  WaitForReaders(events, 1);
  WaitForReaders(states, 1);
  self.peer.Meet("matched");
  const pid_t reader = self.peer.Receive<pid_t>();
  std::vector<std::uint8_t> bytes(kBytes);
  int written = 0;
  dds_time_t start;
  dds_return_t result;
  do {
    std::string name = std::to_string(written);
    dds_test_Block block{name.data(), {kBytes, kBytes, bytes.data(), false}};
    start = dds_time();
    result = dds_write(events, &block);
    if (result == DDS_RETCODE_OK && ++written == 100'000) Fail("the writer never waits");
  } while (result == DDS_RETCODE_OK);
  CheckDue(self, "the write's end", dds_time(), start + kMostBlocking);
  Event("a writer that keeps all: %s", Code(result));
  for (int i = 0; i < kStates; i++) {
    const dds_test_Sample sample{1, i};
    OK(dds_write(states, &sample));
  }
  Event("one that keeps the last: ok");
  self.peer.Send(written);
  if (kill(reader, SIGCONT) != 0) Fail("the reader cannot be continued");
  self.peer.Await("taken");
}

void Reader(Process& self) {
  const dds_entity_t events = self.Reader(self.Topic("block", &dds_test_Block_desc));
  const dds_entity_t states = self.Reader(self.Topic());
  WaitForWriters(events, 1);
  WaitForWriters(states, 1);
  self.peer.Meet("matched");
  self.peer.Send(getpid());
  raise(SIGSTOP);
  const int written = self.peer.Receive<int>();
  for (int i = 0; i < written;) {
    WaitForState(events, DDS_ANY_STATE);
    void* samples[1] = {};
    dds_sample_info_t info;
    if (OK(dds_take(events, samples, &info, 1, 1)) == 0) continue;
    const int number = atoi(static_cast<const dds_test_Block*>(samples[0])->name);
    if (number != i++) Fail("%d came in place of %d", number, i - 1);
    OK(dds_return_loan(events, samples, 1));
  }
  Event("all came of the one that keeps all");
  int before = -1;
  while (before < kStates - 1) {
    WaitForState(states, DDS_ANY_STATE);
    for (const Received& r : All(states)) {
      if (r.sample.value <= before) Fail("%d came after %d", r.sample.value, before);
      before = r.sample.value;
    }
  }
  Event("and the last of the other");
  self.peer.Reached("taken");
}

}  // namespace

TCS_DDS_SCENARIO(stopped_reader, Writer, Reader);
