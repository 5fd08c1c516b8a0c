// The same topic in two domains, both processes in both of them: nothing crosses.
#include "tests/dds/support/process.h"
#include "tests/dds/support/samples.h"

namespace {

using namespace dds_test;

dds_entity_t TopicOf(dds_entity_t participant) {
  return OK(dds_create_topic(participant, &dds_test_Sample_desc, "a", nullptr, nullptr));
}

void Writer(Process& self) {
  const dds_entity_t beside = self.Participant(1);
  const dds_entity_t here = self.Writer(self.Topic());
  const dds_entity_t there = OK(dds_create_writer(beside, TopicOf(beside), Plain().get(), nullptr));
  WaitForReaders(here, 1);
  WaitForReaders(there, 1);
  self.peer.Meet("matched");
  Write(here, 1, 1);
  Write(there, 2, 2);
  Write(here, 90, 0);
  Write(there, 90, 0);
  self.peer.Meet("told");
  OK(dds_delete(beside));
}

void Reader(Process& self) {
  const dds_entity_t beside = self.Participant(1);
  const dds_entity_t here = self.Reader(self.Topic());
  const dds_entity_t there = OK(dds_create_reader(beside, TopicOf(beside), Plain().get(), nullptr));
  WaitForWriters(here, 1);
  WaitForWriters(there, 1);
  self.peer.Meet("matched");
  WaitForSample<90>(here);
  WaitForSample<90>(there);
  TakeAndTell(here, "here");
  TakeAndTell(there, "there");
  self.peer.Meet("told");
  OK(dds_delete(beside));
}

}  // namespace

TCS_DDS_SCENARIO(domains, Writer, Reader);
