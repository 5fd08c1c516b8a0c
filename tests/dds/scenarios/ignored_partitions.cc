// Endpoints of partitions and topics that the configuration ignores (IgnoredPartitions) match in
// their own domain only, also by partitions of theirs that are not ignored. The other process
// ignores nothing.
#include "tests/dds/support/matches.h"
#include "tests/dds/support/process.h"
#include "tests/dds/support/samples.h"

namespace {

using namespace dds_test;

dds_entity_t TopicOf(dds_entity_t participant, const char* name) {
  return OK(dds_create_topic(participant, &dds_test_Sample_desc, name, nullptr, nullptr));
}

dds_entity_t WriterOf(dds_entity_t participant, dds_entity_t topic, std::vector<const char*> in) {
  Qos qos;
  dds_qset_partition(const_cast<dds_qos_t*>(qos.get()), static_cast<std::uint32_t>(in.size()),
                     in.data());
  const dds_entity_t publisher = OK(dds_create_publisher(participant, qos.get(), nullptr));
  return OK(dds_create_writer(publisher, topic, Plain().get(), nullptr));
}

dds_entity_t ReaderOf(dds_entity_t participant, dds_entity_t topic, std::vector<const char*> in) {
  Qos qos;
  dds_qset_partition(const_cast<dds_qos_t*>(qos.get()), static_cast<std::uint32_t>(in.size()),
                     in.data());
  const dds_entity_t subscriber = OK(dds_create_subscriber(participant, qos.get(), nullptr));
  return OK(dds_create_reader(subscriber, topic, Plain().get(), nullptr));
}

void Writer(Process& self) {
  self.DomainBeside(
      "<Partitioning><IgnoredPartitions>"
      "<IgnoredPartition DCPSPartitionTopic=\".a\"/>"
      "<IgnoredPartition DCPSPartitionTopic=\"left*.b\"/>"
      "</IgnoredPartitions></Partitioning>");
  const dds_entity_t participant = self.Participant(1);
  const dds_entity_t a = TopicOf(participant, "a"), b = TopicOf(participant, "b"),
                     c = TopicOf(participant, "c");
  const dds_entity_t before = WriterOf(participant, a, {""});
  const dds_entity_t mixed_before = ReaderOf(participant, b, {"left/1", "right"});
  self.peer.Meet("some are there");
  const dds_entity_t plain = WriterOf(participant, c, {""});
  WaitForReaders(plain, 1);
  const dds_entity_t after = WriterOf(participant, a, {""});
  const dds_entity_t own = ReaderOf(participant, a, {""});
  const dds_entity_t mixed = ReaderOf(participant, b, {"left/1", "right"});
  const dds_entity_t mixed_writer = WriterOf(participant, b, {"left/2", "right"});
  const dds_entity_t elsewhere = WriterOf(participant, b, {"right"});
  WaitForReaders(elsewhere, 3);
  self.peer.Meet("all are there");
  Write(before, 1, 1);
  Write(after, 2, 2);
  Write(mixed_writer, 3, 3);
  Write(elsewhere, 4, 4);
  Write(plain, 5, 5);
  self.peer.Meet("written");
  dds_sleepfor(DDS_MSECS(200));
  TellReaders("ignored", before);
  TellReaders("ignored, later", after);
  TellReaders("ignored in one partition", mixed_writer);
  TellReaders("not ignored", elsewhere);
  TellWriters("ignored", own);
  TellWriters("ignored in one partition", mixed_before);
  TellWriters("ignored in one partition, later", mixed);
  TakeAndTell(own, "ignored");
  TakeAndTell(mixed_before, "ignored in one partition");
  TakeAndTell(mixed, "ignored in one partition, later");
  self.peer.Meet("told");
  OK(dds_delete(participant));
}

void Reader(Process& self) {
  const dds_entity_t participant = self.Participant(1);
  const dds_entity_t a = TopicOf(participant, "a"), b = TopicOf(participant, "b"),
                     c = TopicOf(participant, "c");
  self.peer.Meet("some are there");
  const dds_entity_t reader_a = ReaderOf(participant, a, {""});
  const dds_entity_t reader_b = ReaderOf(participant, b, {"right"});
  const dds_entity_t writer_b = WriterOf(participant, b, {"right"});
  const dds_entity_t plain = ReaderOf(participant, c, {""});
  WaitForWriters(plain, 1);
  WaitForWriters(reader_b, 2);
  self.peer.Meet("all are there");
  Write(writer_b, 6, 6);
  self.peer.Meet("written");
  dds_sleepfor(DDS_MSECS(200));
  TellWriters("of what the other ignores", reader_a);
  TellReaders("to what the other ignores in one partition", writer_b);
  TakeAndTell(reader_a, "a");
  TakeAndTell(reader_b, "b");
  TakeAndTell(plain, "c");
  self.peer.Meet("told");
  OK(dds_delete(participant));
}

}  // namespace

TCS_DDS_SCENARIO(ignored_partitions, Writer, Reader);
