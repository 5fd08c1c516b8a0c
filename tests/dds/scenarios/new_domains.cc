// A program deletes all that it has of DDS (DDS_CYCLONEDDS_HANDLE) and begins anew, with two
// domains of one name on the network: each time its endpoints meet those that there are, and none
// of before, in the other domain as in another process.
#include <string>

#include "tests/dds/support/process.h"
#include "tests/dds/support/samples.h"

namespace {

using namespace dds_test;

constexpr int kRounds = 3;

dds_entity_t TopicOf(dds_entity_t participant) {
  return OK(dds_create_topic(participant, &dds_test_Sample_desc, "a", nullptr, nullptr));
}

void TellMatches(int round, dds_entity_t writer, dds_entity_t reader) {
  dds_publication_matched_status_t readers;
  dds_subscription_matched_status_t writers;
  OK(dds_get_publication_matched_status(writer, &readers));
  OK(dds_get_subscription_matched_status(reader, &writers));
  Event("round %d: %u readers, %u so far; %u writers, %u so far", round, readers.current_count,
        readers.total_count, writers.current_count, writers.total_count);
}

void Writer(Process& self) {
  for (int round = 1; round <= kRounds; round++) {
    self.DomainBeside("<Discovery><ExternalDomainId>" + std::to_string(self.domain) +
                      "</ExternalDomainId></Discovery>");
    const dds_entity_t beside = self.Participant(1);
    const dds_entity_t writer = self.Writer(self.Topic());
    const dds_entity_t reader =
        OK(dds_create_reader(beside, TopicOf(beside), Plain().get(), nullptr));
    WaitForReaders(writer, 2);
    WaitForWriters(reader, 1);
    self.peer.Meet("matched");
    Write(writer, round, 10 * round);
    WaitForState(reader, DDS_ANY_STATE);
    TellMatches(round, writer, reader);
    TakeAndTell(reader, "in the other domain");
    self.peer.Meet("told");
    OK(dds_delete(DDS_CYCLONEDDS_HANDLE));
    self.peer.Meet("deleted");
    // Whoever looks late would see one writer go and the next one come at once.
    self.peer.Meet("seen");
    self.participant = self.Participant();
  }
}

void Reader(Process& self) {
  const dds_entity_t reader = self.Reader(self.Topic());
  for (int round = 1; round <= kRounds; round++) {
    WaitForWriters(reader, 1);
    self.peer.Meet("matched");
    WaitForState(reader, DDS_ANY_STATE);
    TakeAndTell(reader, "in another process");
    self.peer.Meet("told");
    self.peer.Meet("deleted");
    WaitForWriters(reader, 0);
    TakeAndTell(reader, "its end");
    self.peer.Meet("seen");
  }
}

}  // namespace

TCS_DDS_SCENARIO(new_domains, Writer, Reader);
