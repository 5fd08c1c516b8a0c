// Deadlines are missed when they are over, on both sides, and again a period later.
#include <mutex>
#include <vector>

#include "tests/dds/support/process.h"
#include "tests/dds/support/samples.h"
#include "tests/dds/support/timing.h"

namespace {

using namespace dds_test;

constexpr dds_duration_t kDeadline = DDS_MSECS(40);
constexpr std::size_t kTimes = 3;

struct Misses {
  void Missed() {
    const dds_time_t now = dds_time();
    const std::lock_guard guard(lock);
    times.push_back(now);
  }
  std::vector<dds_time_t> Wait() {
    std::vector<dds_time_t> result;
    WaitUntil("deadlines are missed", [&] {
      const std::lock_guard guard(lock);
      result = times;
      return times.size() >= kTimes;
    });
    return result;
  }

  std::mutex lock;
  std::vector<dds_time_t> times;
};

void Check(const Process& self, const std::vector<dds_time_t>& times, dds_time_t written) {
  dds_time_t due = written;
  for (std::size_t i = 0; i < kTimes; i++) {
    due += kDeadline;
    CheckDue(self, "a deadline", times[i], due);
  }
  Event("%zu deadlines were missed when due", kTimes);
}

void Writer(Process& self) {
  Misses misses;
  dds_listener_t* listener = dds_create_listener(&misses);
  dds_lset_offered_deadline_missed(
      listener, [](dds_entity_t, const dds_offered_deadline_missed_status_t, void* m) {
        static_cast<Misses*>(m)->Missed();
      });
  const dds_entity_t writer = OK(dds_create_writer(
      self.participant, self.Topic(), Qos().Reliable().Deadline(kDeadline).get(), listener));
  dds_delete_listener(listener);
  WaitForReaders(writer, 1);
  self.peer.Meet("matched");
  const dds_time_t before = dds_time();
  Write(writer, 1, 1);
  Check(self, misses.Wait(), before);
  OK(dds_set_listener(writer, nullptr));
}

void Reader(Process& self) {
  Misses misses;
  dds_listener_t* listener = dds_create_listener(&misses);
  dds_lset_requested_deadline_missed(
      listener, [](dds_entity_t, const dds_requested_deadline_missed_status_t, void* m) {
        static_cast<Misses*>(m)->Missed();
      });
  const dds_entity_t reader =
      OK(dds_create_reader(self.participant, self.Topic(),
                           Qos().Reliable().KeepAll().Deadline(kDeadline).get(), listener));
  dds_delete_listener(listener);
  WaitForWriters(reader, 1);
  self.peer.Meet("matched");
  const std::vector<dds_time_t> times = misses.Wait();
  OK(dds_set_listener(reader, nullptr));
  Check(self, times, All(reader).at(0).info.source_timestamp);
}

}  // namespace

TCS_DDS_SCENARIO(timed_deadline, Writer, Reader);
