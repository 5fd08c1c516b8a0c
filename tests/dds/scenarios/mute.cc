// A program makes its domain mute (dds_domain_set_deafmute), for less than its lease and then for
// longer. What it writes meanwhile comes when it is heard again, if it is reliable. A writer that
// keeps all waits when nobody acknowledges what it has written. After the lease others have lost
// it, but it has not lost them.
#include "tests/dds/support/process.h"
#include "tests/dds/support/samples.h"

namespace {

using namespace dds_test;

Qos Lossy() { return Qos().BestEffort().KeepAll(); }
Qos Impatient() { return Qos().Reliable(DDS_MSECS(100)).KeepAll(); }

void WaitForMarker(dds_entity_t reader, int round) {
  round == 1 ? WaitForSample<kMarkers + 1>(reader) : WaitForSample<kMarkers + 2>(reader);
}

void BeMute(const Process& self, bool mute, dds_duration_t reset_after) {
  OK(dds_domain_set_deafmute(self.participant, false, mute, reset_after));
}

void WriteUntilFull(dds_entity_t writer) {
  dds_return_t result = DDS_RETCODE_OK;
  for (int value = 1; result == DDS_RETCODE_OK && value < 1000000; value++) {
    const dds_test_Sample sample{3, value};
    result = dds_write(writer, &sample);
  }
  Event("mute, to a writer without end: %s", Code(result));
}

void Writer(Process& self) {
  self.DomainBeside(
      "<Discovery><LeaseDuration>2s</LeaseDuration></Discovery>"
      "<Internal><Watermarks><WhcAdaptive>false</WhcAdaptive><WhcHigh>10kB</WhcHigh>"
      "<WhcHighInit>10kB</WhcHighInit></Watermarks></Internal>");
  self.participant = self.Participant(1);
  const dds_entity_t writer = self.Writer(self.Topic());
  const dds_entity_t lossy = self.Writer(self.Topic("b"), Lossy());
  const dds_entity_t full = self.Writer(self.Topic("c"), Impatient());
  for (const dds_entity_t one : {writer, lossy, full}) WaitForReaders(one, 1);
  self.peer.Meet("matched");
  for (int round = 1; round <= 2; round++) {
    BeMute(self, true, round == 1 ? DDS_SECS(1) : DDS_INFINITY);
    Write(writer, 1, 10 * round);
    Write(lossy, 1, 10 * round);
    if (round == 1) WriteUntilFull(full);
    self.peer.Meet("written");
    self.peer.Await("deaf");
    dds_publication_matched_status_t status;
    OK(dds_get_publication_matched_status(writer, &status));
    Event("mute: %u readers, %u so far", status.current_count, status.total_count);
    if (round == 2) BeMute(self, false, DDS_INFINITY);
    Write(writer, kMarkers + round, 0);
    self.peer.Await("told");
    Write(lossy, 2, 10 * round + 1);
    Write(lossy, kMarkers + round, 0);
    self.peer.Meet("told of both");
  }
}

void Reader(Process& self) {
  self.UseShortLease("2s");
  const dds_entity_t reader = self.Reader(self.Topic());
  const dds_entity_t lossy = self.Reader(self.Topic("b"), Lossy());
  const dds_entity_t full = self.Reader(self.Topic("c"));
  for (const dds_entity_t one : {reader, lossy, full}) WaitForWriters(one, 1);
  self.peer.Meet("matched");
  for (int round = 1; round <= 2; round++) {
    self.peer.Meet("written");
    dds_sleepfor(DDS_MSECS(200));
    if (round == 2) WaitForWriters(reader, 0);
    dds_subscription_matched_status_t status;
    OK(dds_get_subscription_matched_status(reader, &status));
    Event("of a mute writer: %u writers, %u so far", status.current_count, status.total_count);
    TakeAndTell(reader, "of a mute writer");
    self.peer.Reached("deaf");
    WaitForMarker(reader, round);
    TakeAndTell(reader, "when it is heard again");
    WaitForWriters(lossy, 1);
    self.peer.Reached("told");
    WaitForMarker(lossy, round);
    TakeAndTell(lossy, "when it is heard again, best effort");
    self.peer.Meet("told of both");
  }
}

}  // namespace

TCS_DDS_SCENARIO(mute, Writer, Reader);
