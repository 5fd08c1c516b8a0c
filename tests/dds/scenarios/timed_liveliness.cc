// A writer that has to assert its liveliness loses it when its lease is over, counted from its last
// write, and the reader sees it not alive then.
#include <atomic>

#include "tests/dds/support/process.h"
#include "tests/dds/support/samples.h"
#include "tests/dds/support/timing.h"

namespace {

using namespace dds_test;

constexpr dds_duration_t kLease = DDS_MSECS(150);

void Writer(Process& self) {
  std::atomic<dds_time_t> lost = 0;
  dds_listener_t* listener = dds_create_listener(&lost);
  dds_lset_liveliness_lost(listener,
                           [](dds_entity_t, const dds_liveliness_lost_status_t, void* at) {
                             static_cast<std::atomic<dds_time_t>*>(at)->store(dds_time());
                           });
  const dds_entity_t writer = OK(dds_create_writer(
      self.participant, self.Topic(),
      Qos().Reliable().Liveliness(DDS_LIVELINESS_MANUAL_BY_TOPIC, kLease).get(), listener));
  dds_delete_listener(listener);
  WaitForReaders(writer, 1);
  self.peer.Meet("matched");
  const dds_time_t before = dds_time();
  Write(writer, 1, 1);
  WaitUntil("liveliness is lost", [&] { return lost != 0; });
  OK(dds_set_listener(writer, nullptr));
  CheckOwnDue(self, "the loss of liveliness", lost, before + kLease);
  Event("liveliness was lost when due");
}

void Reader(Process& self) {
  std::atomic<dds_time_t> not_alive = 0;
  dds_listener_t* listener = dds_create_listener(&not_alive);
  dds_lset_liveliness_changed(
      listener, [](dds_entity_t, const dds_liveliness_changed_status_t status, void* at) {
        if (status.not_alive_count == 1)
          static_cast<std::atomic<dds_time_t>*>(at)->store(dds_time());
      });
  const dds_entity_t reader = OK(dds_create_reader(
      self.participant, self.Topic(),
      Qos().Reliable().KeepAll().Liveliness(DDS_LIVELINESS_MANUAL_BY_TOPIC, kLease).get(),
      listener));
  dds_delete_listener(listener);
  WaitForWriters(reader, 1);
  self.peer.Meet("matched");
  WaitForSample<1>(reader);
  WaitUntil("the writer is not alive", [&] { return not_alive != 0; });
  OK(dds_set_listener(reader, nullptr));
  CheckDue(self, "the end of the lease", not_alive,
           All(reader).at(0).info.source_timestamp + kLease);
  Event("the writer was not alive when its lease was over");
}

}  // namespace

TCS_DDS_SCENARIO(timed_liveliness, Writer, Reader);
