// A program that looks up participants, or asks for what a domain has, finds its own, and not those
// of others.
#include "tests/dds/support/process.h"
#include "tests/dds/support/waits.h"

namespace {

using namespace dds_test;

void Play(Process& self) {
  const dds_entity_t topic = self.Topic();
  const dds_entity_t reader = self.Reader(topic), writer = self.Writer(topic);
  WaitForWriters(reader, 2);
  WaitForReaders(writer, 2);
  dds_domainid_t domain;
  OK(dds_get_domainid(self.participant, &domain));
  dds_entity_t found[4] = {};
  Event("participants: %d", OK(dds_lookup_participant(domain, found, 4)));
  Event("%s", found[0] == self.participant && found[1] == 0 ? "its own" : "another one");
  Event("counted: %d", OK(dds_lookup_participant(domain, nullptr, 0)));
  Event("children of the domain: %d",
        OK(dds_get_children(dds_get_parent(self.participant), found, 4)));
  Event("children of the participant: %d", OK(dds_get_children(self.participant, found, 4)));
  self.peer.Meet("told");
}

}  // namespace

TCS_DDS_SCENARIO(participant_lookup, Play, Play);
