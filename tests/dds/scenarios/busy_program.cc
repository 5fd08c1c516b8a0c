// A program computes for long without a call into DDS: its automatic liveliness goes on, its
// listener is called, and reliable writers do not wait for it.
#include <atomic>

#include "tests/dds/support/process.h"
#include "tests/dds/support/samples.h"
#include "tests/dds/support/timing.h"

namespace {

using namespace dds_test;

constexpr dds_duration_t kLease = DDS_MSECS(400);
constexpr dds_duration_t kComputingFor = 3 * kLease;
constexpr int kSamples = 100;

void Writer(Process& self) {
  const dds_entity_t topic = self.Topic(), back = self.Topic("b");
  const dds_entity_t writer = self.Writer(topic), reader = self.Reader(back, Leased(kLease));
  WaitForReaders(writer, 1);
  WaitForWriters(reader, 1);
  self.peer.Meet("matched");
  for (int i = 0; i < kSamples; i++) {
    Write(writer, 1, i);
    dds_sleepfor(kComputingFor / kSamples);
  }
  self.peer.Await("computed");
  dds_liveliness_changed_status_t status;
  OK(dds_get_liveliness_changed_status(reader, &status));
  Event("%u alive, %u not alive", status.alive_count, status.not_alive_count);
}

void Reader(Process& self) {
  std::atomic<int> seen = 0;
  dds_listener_t* listener = dds_create_listener(&seen);
  dds_lset_data_available(listener, [](dds_entity_t from, void* count) {
    *static_cast<std::atomic<int>*>(count) += static_cast<int>(All(from).size());
  });
  const dds_entity_t topic = self.Topic(), back = self.Topic("b");
  const dds_entity_t reader =
      OK(dds_create_reader(self.participant, topic, Plain().get(), listener));
  dds_delete_listener(listener);
  const dds_entity_t writer = self.Writer(back, Leased(kLease));
  WaitForWriters(reader, 1);
  WaitForReaders(writer, 1);
  self.peer.Meet("matched");
  const dds_time_t end = dds_time() + kComputingFor;
  while (dds_time() < end) {
  }
  Event("the listener was called meanwhile: %s", seen > 0 ? "yes" : "no");
  self.peer.Reached("computed");
  WaitUntil("all has come", [&] { return seen == kSamples; });
  OK(dds_set_listener(reader, nullptr));
}

}  // namespace

TCS_DDS_SCENARIO(busy_program, Writer, Reader);
