// Domains meet by what they are called on the network (ExternalDomainId), not by the numbers that
// programs give them: one of another number with the same name does, be it in the same process or
// in another one; one of the same number with another name does not.
#include <string>

#include "tests/dds/support/process.h"
#include "tests/dds/support/samples.h"

namespace {

using namespace dds_test;

dds_entity_t TopicOf(dds_entity_t participant) {
  return OK(dds_create_topic(participant, &dds_test_Sample_desc, "a", nullptr, nullptr));
}

Qos Lasting() { return Plain().TransientLocal(); }

// The writers are in the domain beside, which is called as the scenario's is; so of its readers in
// two domains both meet them.
void Writer(Process& self) {
  const dds_entity_t domain =
      self.DomainBeside("<Discovery><ExternalDomainId>" + std::to_string(self.domain) +
                        "</ExternalDomainId></Discovery>");
  const dds_entity_t beside = self.Participant(1);
  const dds_entity_t topic = TopicOf(beside), topic_here = self.Topic();
  const dds_entity_t writer = OK(dds_create_writer(beside, topic, Lasting().get(), nullptr));
  const dds_entity_t same = OK(dds_create_reader(beside, topic, Lasting().get(), nullptr));
  const dds_entity_t here = self.Reader(topic_here, Lasting());
  WaitForReaders(writer, 3);
  WaitForWriters(same, 1);
  WaitForWriters(here, 1);
  self.peer.Meet("matched");
  Write(writer, 1, 10);
  Write(writer, 2, 20);
  const dds_test_Sample gone{2, 0};
  OK(dds_dispose(writer, &gone));
  Write(writer, 90, 0);
  WaitForSample<90>(same);
  WaitForSample<90>(here);
  TakeAndTell(same, "in its domain");
  TakeAndTell(here, "in the other one of its process");

  const dds_entity_t late = self.Reader(topic_here, Lasting());
  WaitForSample<90>(late);
  TakeAndTell(late, "in the other one, late");
  self.peer.Meet("told");

  const dds_entity_t back = self.Writer(topic_here, Lasting());
  WaitForReaders(back, 4);
  Write(back, 3, 30);
  Write(back, 91, 0);
  WaitForSample<91>(same);
  TakeAndTell(same, "from the other one");
  self.peer.Meet("told of both");

  OK(dds_delete(domain));
  WaitForWriters(here, 1);
  WaitForReaders(back, 3);
  TakeAndTell(here, "its end");
  self.peer.Meet("ended");
}

void Reader(Process& self) {
  const dds_entity_t beside = self.Participant(1);
  const dds_entity_t apart =
      OK(dds_create_reader(beside, TopicOf(beside), Lasting().get(), nullptr));
  const dds_entity_t reader = self.Reader(self.Topic(), Lasting());
  WaitForWriters(reader, 1);
  self.peer.Meet("matched");
  WaitForSample<90>(reader);
  TakeAndTell(reader, "in another process");
  self.peer.Meet("told");
  WaitForSample<91>(reader);
  TakeAndTell(reader, "in another process, from the other one");
  self.peer.Meet("told of both");
  WaitForWriters(reader, 1);
  self.peer.Meet("ended");
  dds_sleepfor(DDS_MSECS(200));
  dds_subscription_matched_status_t status;
  OK(dds_get_subscription_matched_status(apart, &status));
  Event("of the same number: %u writers", status.total_count);
  TakeAndTell(apart, "of the same number");
}

}  // namespace

TCS_DDS_SCENARIO(external_domains, Writer, Reader);
