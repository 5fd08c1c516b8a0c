// Two writers write as fast as they can: each of two readers gets every sample once, those of a
// writer in their order.
#include <thread>

#include "tests/dds/support/process.h"
#include "tests/dds/support/samples.h"

namespace {

using namespace dds_test;

constexpr int kSamples = 5000;

void Writer(Process& self) {
  const dds_entity_t topic = self.Topic();
  const dds_entity_t writers[] = {self.Writer(topic), self.Writer(topic)};
  for (const dds_entity_t writer : writers) WaitForReaders(writer, 2);
  self.peer.Meet("matched");
  std::thread threads[2];
  for (int i = 0; i < 2; i++) {
    threads[i] = std::thread([writer = writers[i], i] {
      for (int value = 0; value < kSamples; value++) Write(writer, i, value);
    });
  }
  for (std::thread& thread : threads) thread.join();
}

void Reader(Process& self) {
  const dds_entity_t topic = self.Topic();
  const dds_entity_t readers[] = {self.Reader(topic), self.Reader(topic)};
  for (const dds_entity_t reader : readers) WaitForWriters(reader, 2);
  self.peer.Meet("matched");
  for (const dds_entity_t reader : readers) {
    int next[2] = {};
    while (next[0] + next[1] < 2 * kSamples) {
      WaitForState(reader, DDS_ANY_STATE);
      for (const auto& [sample, info] : All(reader)) {
        if (sample.value != next[sample.key])
          Fail("of writer %d, %d came in place of %d", sample.key, sample.value, next[sample.key]);
        next[sample.key]++;
      }
    }
    Event("%d and %d samples, in order", next[0], next[1]);
  }
}

}  // namespace

TCS_DDS_SCENARIO(burst, Writer, Reader);
