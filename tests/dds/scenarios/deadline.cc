// A writer that has promised a sample of each instance every 50 ms writes one and stops: both sides
// learn of each deadline that passes, the reader also of which instance it was.
#include "tests/dds/support/process.h"
#include "tests/dds/support/samples.h"

namespace {

using namespace dds_test;

constexpr dds_duration_t kDeadline = DDS_MSECS(50);

void Writer(Process& self) {
  const dds_entity_t writer = self.Writer(self.Topic(), Qos().Reliable().Deadline(kDeadline));
  WaitForReaders(writer, 1);
  self.peer.Meet("matched");
  Write(writer, 7, 1);
  WaitForStatus(writer, DDS_OFFERED_DEADLINE_MISSED_STATUS, [&, told = 0u]() mutable {
    dds_offered_deadline_missed_status_t status;
    OK(dds_get_offered_deadline_missed_status(writer, &status));
    for (; told < 2 && told < status.total_count; told++)
      Event("offered deadline missed: %u", told + 1);
    return told == 2;
  });
  self.peer.Meet("told");
  // Deadlines are of living instances only.
  const dds_test_Sample seven{7, 0};
  OK(dds_unregister_instance(writer, &seven));
  dds_offered_deadline_missed_status_t before, after;
  OK(dds_get_offered_deadline_missed_status(writer, &before));
  dds_sleepfor(3 * kDeadline);
  OK(dds_get_offered_deadline_missed_status(writer, &after));
  Event("missed after it was unregistered: %u", after.total_count - before.total_count);
}

void Reader(Process& self) {
  const dds_entity_t reader =
      self.Reader(self.Topic(), Qos().Reliable().KeepAll().Deadline(kDeadline));
  WaitForWriters(reader, 1);
  self.peer.Meet("matched");
  WaitForStatus(reader, DDS_REQUESTED_DEADLINE_MISSED_STATUS, [&, told = 0u]() mutable {
    dds_requested_deadline_missed_status_t status;
    OK(dds_get_requested_deadline_missed_status(reader, &status));
    dds_test_Sample sample{};
    if (status.total_count > 0)
      OK(dds_instance_get_key(reader, status.last_instance_handle, &sample));
    for (; told < 2 && told < status.total_count; told++)
      Event("requested deadline of %d missed: %u", sample.key, told + 1);
    return told == 2;
  });
  TakeAndTell(reader, "reader");
  self.peer.Meet("told");
}

}  // namespace

TCS_DDS_SCENARIO(deadline, Writer, Reader);
