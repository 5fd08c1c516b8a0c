// A sample's source timestamp is the time of its write, and nobody has the sample before that time.
// Where samples are carried exactly, whoever waits has it as soon as it is received.
#include <time.h>

#include "tests/dds/support/process.h"
#include "tests/dds/support/samples.h"
#include "tests/dds/support/timing.h"

namespace {

using namespace dds_test;

constexpr int kSamples = 20;

dds_time_t RealTime() {
  timespec t;
  clock_gettime(CLOCK_REALTIME, &t);
  return t.tv_sec * DDS_NSECS_IN_SEC + t.tv_nsec;
}

struct Written {
  dds_time_t before[kSamples], after[kSamples];
};

void Writer(Process& self) {
  const dds_entity_t writer = self.Writer(self.Topic());
  WaitForReaders(writer, 3);
  self.peer.Meet("matched");
  Written written;
  for (int i = 0; i < kSamples; i++) {
    written.before[i] = RealTime();
    Write(writer, 1, i);
    written.after[i] = dds_time();
    // At odd distances, so that no timer of the protocol's own falls together with them.
    dds_sleepfor(DDS_USECS(1700) * (i % 4 + 1));
  }
  Write(writer, 90, 0);
  self.peer.Send(written);
  self.peer.Await("taken");
  Write(writer, 2, 1);
  self.peer.Reached("written at last");
}

void Reader(Process& self) {
  const dds_entity_t topic = self.Topic();
  // One is asked again and again, one is waited for, one is looked at when the writer says so.
  const dds_entity_t polled = self.Reader(topic), waited = self.Reader(topic),
                     told = self.Reader(topic);
  for (const dds_entity_t reader : {polled, waited, told}) WaitForWriters(reader, 1);
  self.peer.Meet("matched");
  const dds_entity_t any = OK(dds_create_readcondition(waited, DDS_ANY_STATE));
  dds_time_t stamps[kSamples] = {};
  for (int seen = 0; seen < kSamples;) {
    WaitForTrigger(any);
    for (const auto& [sample, info] : All(waited)) {
      CheckDue(self, "a sample that was waited for", dds_time(), info.source_timestamp);
      if (sample.key == 1) stamps[seen++] = info.source_timestamp;
    }
    for (const auto& [sample, info] : All(polled)) {
      if (dds_time() < info.source_timestamp) Fail("a sample was there before its write");
    }
  }
  const auto written = self.peer.Receive<Written>();
  for (int i = 0; i < kSamples; i++) {
    if (stamps[i] < written.before[i] || stamps[i] > written.after[i])
      Fail("a source timestamp is not of the time of the write");
  }
  Event("%d source timestamps are of the times of the writes", kSamples);
  WaitForSample<90>(told);
  All(told);
  self.peer.Reached("taken");
  self.peer.Await("written at last");
  // The thread that receives has its work with it first.
  WaitForSample<2>(told);
  for (const auto& [sample, info] : All(told)) {
    CheckDue(self, "the last sample", dds_time(), info.source_timestamp);
  }
}

}  // namespace

TCS_DDS_SCENARIO(timed_samples, Writer, Reader);
