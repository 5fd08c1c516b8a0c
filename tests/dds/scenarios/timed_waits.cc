// Cyclone's own waits take the time that they say: sleeps, waitsets with a timeout and until a
// time.
#include "tests/dds/support/process.h"
#include "tests/dds/support/samples.h"
#include "tests/dds/support/timing.h"

namespace {

using namespace dds_test;

void Play(Process& self) {
  const dds_entity_t set = OK(dds_create_waitset(self.participant));
  // An empty one returns at once.
  OK(dds_waitset_attach(set, OK(dds_create_guardcondition(self.participant)), 0));
  const dds_duration_t durations[] = {DDS_USECS(50), DDS_MSECS(1), DDS_MSECS(37)};
  for (const dds_duration_t duration : durations) {
    dds_time_t start = dds_time();
    dds_sleepfor(duration);
    CheckOwnDue(self, "a sleep", dds_time(), start + duration);
    start = dds_time();
    Event("timeout: %d", OK(dds_waitset_wait(set, nullptr, 0, duration)));
    CheckOwnDue(self, "a waitset's timeout", dds_time(), start + duration);
    start = dds_time();
    Event("until: %d", OK(dds_waitset_wait_until(set, nullptr, 0, start + duration)));
    CheckOwnDue(self, "a waitset's end", dds_time(), start + duration);
  }
}

}  // namespace

TCS_DDS_SCENARIO(timed_waits, Play, Play);
