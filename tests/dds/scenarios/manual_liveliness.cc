// A writer that has to assert its liveliness by hand does so for a while, stops, and writes again:
// it learns that it lost it, the reader sees it alive, not alive, and alive again. Its samples
// stay.
#include <mutex>
#include <string>
#include <vector>

#include "tests/dds/support/process.h"
#include "tests/dds/support/samples.h"

namespace {

using namespace dds_test;

constexpr dds_duration_t kLease = DDS_MSECS(400);

void Writer(Process& self) {
  const dds_entity_t writer = self.Writer(
      self.Topic(), Qos().Reliable().Liveliness(DDS_LIVELINESS_MANUAL_BY_TOPIC, kLease));
  WaitForReaders(writer, 1);
  self.peer.Meet("matched");
  Write(writer, 1, 1);
  dds_liveliness_lost_status_t status;
  for (int i = 0; i < 10; i++) {
    dds_sleepfor(kLease / 5);
    OK(dds_assert_liveliness(writer));
  }
  OK(dds_get_liveliness_lost_status(writer, &status));
  Event("lost while it asserted: %u", status.total_count);
  const auto wait_for_loss = [&](std::uint32_t times) {
    WaitForStatus(writer, DDS_LIVELINESS_LOST_STATUS, [&] {
      OK(dds_get_liveliness_lost_status(writer, &status));
      return status.total_count >= times;
    });
    Event("lost: %u", times);
  };
  wait_for_loss(1);
  self.peer.Await("not alive");
  Write(writer, 1, 2);
  wait_for_loss(2);
}

// A listener sees each change by itself; a status may have taken several together.
struct Changes {
  std::mutex lock;
  std::vector<std::string> seen;

  static void Changed(dds_entity_t, const dds_liveliness_changed_status_t status, void* self) {
    Changes& changes = *static_cast<Changes*>(self);
    const std::lock_guard guard(changes.lock);
    changes.seen.push_back(std::to_string(status.alive_count) + " alive, " +
                           std::to_string(status.not_alive_count) + " not alive");
  }

  void WaitFor(std::size_t count) {
    WaitUntil("liveliness changes", [&] {
      const std::lock_guard guard(lock);
      return seen.size() >= count;
    });
    const std::lock_guard guard(lock);
    Event("%s", seen[count - 1].c_str());
  }
};

void Reader(Process& self) {
  Changes changes;
  dds_listener_t* listener = dds_create_listener(&changes);
  dds_lset_liveliness_changed(listener, Changes::Changed);
  const dds_entity_t reader = OK(dds_create_reader(
      self.participant, self.Topic(),
      Qos().Reliable().KeepAll().Liveliness(DDS_LIVELINESS_MANUAL_BY_TOPIC, kLease).get(),
      listener));
  dds_delete_listener(listener);
  WaitForWriters(reader, 1);
  self.peer.Meet("matched");
  changes.WaitFor(1);
  changes.WaitFor(2);
  self.peer.Reached("not alive");
  changes.WaitFor(3);
  changes.WaitFor(4);
  OK(dds_set_listener(reader, nullptr));
  WaitForState(reader, kNotAlive);
  TakeAndTell(reader, "reader");
}

}  // namespace

TCS_DDS_SCENARIO(manual_liveliness, Writer, Reader);
