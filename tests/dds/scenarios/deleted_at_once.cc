// Two threads of a program delete participants in two domains of one name while their endpoints
// are still being found, and a third one makes topics: everybody sees each of them come, and go.
#include <string>
#include <thread>
#include <vector>

#include "tests/dds/support/process.h"
#include "tests/dds/support/samples.h"

namespace {

using namespace dds_test;

constexpr int kRounds = 4;
constexpr std::uint32_t kParticipants = 6;  // in each domain

void MakeWriter(dds_entity_t participant) {
  const dds_entity_t topic =
      OK(dds_create_topic(participant, &dds_test_Sample_desc, "a", nullptr, nullptr));
  OK(dds_create_writer(participant, topic, Plain().get(), nullptr));
}

void DeleteAll(const std::vector<dds_entity_t>& participants) {
  for (const dds_entity_t participant : participants) OK(dds_delete(participant));
}

void MakeTopics(const Process& self) {
  for (std::uint32_t i = 0; i < 4 * kParticipants; i++) OK(dds_delete(self.Topic("b")));
}

void Writer(Process& self) {
  self.DomainBeside("<Discovery><ExternalDomainId>" + std::to_string(self.domain) +
                    "</ExternalDomainId></Discovery>");
  for (int round = 1; round <= kRounds; round++) {
    std::vector<dds_entity_t> here, beside;
    for (std::uint32_t i = 0; i < kParticipants; i++) {
      here.push_back(self.Participant());
      beside.push_back(self.Participant(1));
      MakeWriter(here.back());
      MakeWriter(beside.back());
    }
    self.peer.Meet("made");
    if (round % 2 == 0) self.peer.Await("found");
    std::thread deletes_here(DeleteAll, here), deletes_beside(DeleteAll, beside);
    MakeTopics(self);
    deletes_here.join();
    deletes_beside.join();
    self.peer.Await("gone");
  }
}

void Reader(Process& self) {
  const dds_entity_t reader = self.Reader(self.Topic());
  for (int round = 1; round <= kRounds; round++) {
    self.peer.Meet("made");
    if (round % 2 == 0) {
      WaitForWriters(reader, 2 * kParticipants);
      Event("round %d: all writers", round);
      self.peer.Reached("found");
    }
    WaitForWriters(reader, 0);
    Event("round %d: none", round);
    self.peer.Reached("gone");
  }
}

}  // namespace

TCS_DDS_SCENARIO(deleted_at_once, Writer, Reader);
