// Two writers of one instance, the second of which writes with older timestamps: a reader that
// orders by source timestamp keeps the newer sample, one that orders by reception the last one.
#include "tests/dds/support/process.h"
#include "tests/dds/support/samples.h"

namespace {

using namespace dds_test;

void WriteAt(dds_entity_t writer, int value, dds_time_t time) {
  const dds_test_Sample sample{1, value};
  OK(dds_write_ts(writer, &sample, time));
}

void Writer(Process& self) {
  const dds_entity_t topic = self.Topic();
  const Qos qos = Plain().BySourceTimestamp();
  const dds_entity_t first = self.Writer(topic, qos), second = self.Writer(topic, qos);
  WaitForReaders(first, 2);
  WaitForReaders(second, 2);
  self.peer.Meet("matched");
  const dds_time_t now = dds_time();
  WriteAt(first, 1, now);
  Write(first, 90, 0);
  self.peer.Await("first is here");
  WriteAt(second, 2, now - DDS_SECS(1));
  Write(second, 91, 0);
}

void Reader(Process& self) {
  const dds_entity_t topic = self.Topic();
  const dds_entity_t by_source =
      self.Reader(topic, Qos().Reliable().KeepLast(1).BySourceTimestamp());
  const dds_entity_t by_reception = self.Reader(topic, Qos().Reliable().KeepLast(1));
  WaitForWriters(by_source, 2);
  WaitForWriters(by_reception, 2);
  self.peer.Meet("matched");
  for (const dds_entity_t reader : {by_source, by_reception}) WaitForSample<90>(reader);
  self.peer.Reached("first is here");
  for (const dds_entity_t reader : {by_source, by_reception}) WaitForSample<91>(reader);
  TakeAndTell(by_source, "by source timestamp");
  TakeAndTell(by_reception, "by reception");
}

}  // namespace

TCS_DDS_SCENARIO(destination_order, Writer, Reader);
