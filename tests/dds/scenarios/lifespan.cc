// Samples with a lifespan vanish from the reader and from what the writer keeps for late readers;
// those without stay.
#include "tests/dds/support/process.h"
#include "tests/dds/support/samples.h"

namespace {

using namespace dds_test;

void Writer(Process& self) {
  const dds_entity_t topic = self.Topic();
  const dds_entity_t staying = self.Writer(topic, Qos().Reliable().KeepAll().TransientLocal());
  const dds_entity_t vanishing =
      self.Writer(topic, Qos().Reliable().KeepAll().TransientLocal().Lifespan(DDS_MSECS(300)));
  WaitForReaders(staying, 1);
  WaitForReaders(vanishing, 1);
  self.peer.Meet("matched");
  Write(staying, 1, 10);
  Write(staying, 90, 0);
  Write(vanishing, 2, 20);
  Write(vanishing, 2, 21);
}

void Reader(Process& self) {
  const dds_entity_t topic = self.Topic();
  const Qos qos = Qos().Reliable().KeepAll().TransientLocal();
  const dds_entity_t reader = self.Reader(topic, qos);
  WaitForWriters(reader, 2);
  self.peer.Meet("matched");
  WaitForSample<90>(reader);
  std::vector<Received> all;
  WaitUntil("all are there", [&] { return (all = All(reader, How::kRead)).size() == 4; });
  for (const auto& [sample, info] : all) {
    if (sample.key < kMarkers) Event("at first: %d: %d", sample.key, sample.value);
  }
  WaitUntil("some have vanished", [=] { return All(reader, How::kRead).size() == 2; });
  Tell("after their lifespan", All(reader, How::kRead));
  const dds_entity_t late = self.Reader(topic, qos);
  WaitForWriters(late, 2);
  WaitForSample<90>(late);
  TakeAndTell(late, "late reader");
}

}  // namespace

TCS_DDS_SCENARIO(lifespan, Writer, Reader);
