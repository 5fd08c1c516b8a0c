// Samples of a type made by dds_create_topic_sertype, in both processes: data, disposes and
// unregistrations, to a reader that is there and to a late one.
#include <map>
#include <string>

#include "tests/dds/support/process.h"
#include "tests/dds/support/waits.h"
#include "tests/dds/support/word_type.h"

namespace {

using namespace dds_test;

void Writer(Process& self) {
  const dds_entity_t writer =
      self.Writer(CreateWordTopic(self.participant, "words"), Plain().TransientLocal());
  WaitForReaders(writer, 1);
  self.peer.Meet("matched");
  const Word words[] = {{1, "one"}, {2, "two"}, {1, std::string(3000, '1')}, {3, ""}};
  for (const Word& word : words) OK(dds_write(writer, &word));
  self.peer.Await("written");
  OK(dds_dispose(writer, &words[0]));
  OK(dds_unregister_instance(writer, &words[1]));
  const Word last{4, "last"};
  OK(dds_write(writer, &last));
}

std::string Describe(const Word& word, const dds_sample_info_t& info) {
  const std::string text = !info.valid_data ? "no data"
                           : word.text.size() < 10
                               ? "'" + word.text + "'"
                               : std::to_string(word.text.size()) + " characters";
  return text + (info.instance_state == DDS_IST_ALIVE                ? ", alive"
                 : info.instance_state == DDS_IST_NOT_ALIVE_DISPOSED ? ", disposed"
                                                                     : ", no writers");
}

// Waits for the word that comes last, then tells of all but one in the order of their ids.
template <int last>
void Tell(const char* who, dds_entity_t reader, std::int32_t but = 0) {
  const auto is_last = [](const void* word) { return static_cast<const Word*>(word)->id == last; };
  const dds_entity_t condition = OK(dds_create_querycondition(reader, DDS_ANY_STATE, is_last));
  WaitForTrigger(condition);
  OK(dds_delete(condition));
  void* samples[16] = {};
  dds_sample_info_t infos[16];
  const int count = OK(dds_take(reader, samples, infos, 16, 16));
  std::multimap<std::int32_t, std::string> all;
  for (int i = 0; i < count; i++) {
    const Word& word = *static_cast<const Word*>(samples[i]);
    if (word.id != but) all.emplace(word.id, Describe(word, infos[i]));
  }
  OK(dds_return_loan(reader, samples, count));
  for (const auto& [id, text] : all) Event("%s: %d: %s", who, id, text.c_str());
}

void Reader(Process& self) {
  const dds_entity_t topic = CreateWordTopic(self.participant, "words");
  const Qos qos = Plain().TransientLocal();
  const dds_entity_t reader = self.Reader(topic, qos);
  WaitForWriters(reader, 1);
  self.peer.Meet("matched");
  Tell<3>("reader", reader);
  self.peer.Reached("written");
  Tell<4>("reader", reader);
  const dds_entity_t late = self.Reader(topic, qos);
  // Whether the writer still has what it unregistered depends on who has acknowledged it.
  Tell<4>("late reader", late, 2);
}

}  // namespace

TCS_DDS_SCENARIO(custom_sertype, Writer, Reader);
