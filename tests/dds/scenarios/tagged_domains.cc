// Two processes in one domain, which their configurations give different tags: they do not meet.
// Once they have deleted it, and made it again without a tag, they do.
#include <string>

#include "tests/dds/support/process.h"
#include "tests/dds/support/samples.h"

namespace {

using namespace dds_test;

struct Domain {
  dds_entity_t domain, writer, reader;

  Domain(const Process& self, const std::string& discovery) {
    domain = self.DomainBeside(discovery);
    const dds_entity_t participant = self.Participant(1);
    const dds_entity_t topic =
        OK(dds_create_topic(participant, &dds_test_Sample_desc, "a", nullptr, nullptr));
    writer = OK(dds_create_writer(participant, topic, Plain().get(), nullptr));
    reader = OK(dds_create_reader(participant, topic, Plain().get(), nullptr));
  }
};

void Play(Process& self, const char* tag, int key) {
  // What does come over a network says when what does not come would have.
  const dds_entity_t topic = self.Topic();
  const dds_entity_t writer = self.Writer(topic), reader = self.Reader(topic);
  const Domain tagged(self, std::string("<Discovery><Tag>") + tag + "</Tag></Discovery>");
  WaitForReaders(writer, 2);
  WaitForWriters(reader, 2);
  self.peer.Meet("met beside it");
  dds_sleepfor(DDS_MSECS(200));
  dds_instance_handle_t matched[4];
  Event("matched: %d readers, %d writers",
        OK(dds_get_matched_subscriptions(tagged.writer, matched, 4)),
        OK(dds_get_matched_publications(tagged.reader, matched, 4)));
  self.peer.Meet("told");
  OK(dds_delete(tagged.domain));

  const Domain plain(self, "");
  WaitForReaders(plain.writer, 2);
  WaitForWriters(plain.reader, 2);
  self.peer.Meet("matched");
  Write(plain.writer, key, 10 * key);
  Write(plain.writer, 90 + key, 0);
  WaitForSample<91>(plain.reader);
  WaitForSample<92>(plain.reader);
  TakeAndTell(plain.reader, "without a tag");
  self.peer.Meet("done");
  OK(dds_delete(plain.domain));
}

void Left(Process& self) { Play(self, "left", 1); }
void Right(Process& self) { Play(self, "right", 2); }

}  // namespace

TCS_DDS_SCENARIO(tagged_domains, Left, Right);
