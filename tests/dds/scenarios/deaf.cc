// A program makes its domain deaf (dds_domain_set_deafmute), for less than the others' leases and
// then for longer. What a reliable writer writes meanwhile comes when it hears again, what a
// best-effort one writes is lost. After the lease it has lost the others, which have not lost it.
#include "tests/dds/support/matches.h"
#include "tests/dds/support/process.h"
#include "tests/dds/support/samples.h"

namespace {

using namespace dds_test;

Qos Lossy() { return Qos().BestEffort().KeepAll(); }

void Writer(Process& self) {
  self.UseShortLease("2s");
  const dds_entity_t writer = self.Writer(self.Topic());
  const dds_entity_t lossy = self.Writer(self.Topic("b"), Lossy());
  WaitForReaders(writer, 1);
  WaitForReaders(lossy, 1);
  self.peer.Meet("matched");
  for (int round = 1; round <= 2; round++) {
    self.peer.Await("deaf");
    Write(writer, 1, 10 * round);
    Write(lossy, 1, 10 * round);
    self.peer.Meet("written");
    self.peer.Await("hearing");
    TellReaders("beside a deaf reader", writer);
    Write(writer, 2, 10 * round + 1);
    Write(writer, kMarkers + round, 0);
    self.peer.Await("told");
    WaitForReaders(lossy, 1);
    Write(lossy, 2, 10 * round + 1);
    Write(lossy, kMarkers + round, 0);
    self.peer.Meet("told of both");
  }
}

void WaitForMarker(dds_entity_t reader, int round) {
  round == 1 ? WaitForSample<kMarkers + 1>(reader) : WaitForSample<kMarkers + 2>(reader);
}

void BeDeaf(const Process& self, bool deaf) {
  OK(dds_domain_set_deafmute(self.participant, deaf, false, DDS_INFINITY));
}

void Reader(Process& self) {
  self.UseShortLease("2s");
  const dds_entity_t reader = self.Reader(self.Topic());
  const dds_entity_t lossy = self.Reader(self.Topic("b"), Lossy());
  WaitForWriters(reader, 1);
  WaitForWriters(lossy, 1);
  self.peer.Meet("matched");
  for (int round = 1; round <= 2; round++) {
    BeDeaf(self, true);
    dds_sleepfor(DDS_MSECS(100));
    self.peer.Reached("deaf");
    self.peer.Meet("written");
    dds_sleepfor(DDS_MSECS(200));
    if (round == 2) WaitForWriters(reader, 0);
    TellWriters("deaf", reader);
    TakeAndTell(reader, "deaf");
    BeDeaf(self, false);
    WaitForWriters(reader, 1);
    self.peer.Reached("hearing");
    WaitForMarker(reader, round);
    TellWriters("hearing", reader);
    TakeAndTell(reader, "hearing");
    WaitForWriters(lossy, 1);
    self.peer.Reached("told");
    WaitForMarker(lossy, round);
    TakeAndTell(lossy, "hearing, best effort");
    self.peer.Meet("told of both");
  }
}

}  // namespace

TCS_DDS_SCENARIO(deaf, Writer, Reader);
