// Listeners: of readers, of their subscriber, and inherited from the participant. Each is called
// for what it is about, in the order in which things happen.
#include <algorithm>
#include <mutex>
#include <string>
#include <vector>

#include "tests/dds/support/process.h"
#include "tests/dds/support/samples.h"

namespace {

using namespace dds_test;

// What a listener has seen; it runs on Cyclone's threads.
struct Log {
  explicit Log(const char* who) : name(who) {}

  void Add(const std::string& line) {
    const std::lock_guard guard(lock);
    lines.push_back(line);
  }
  void WaitFor(std::size_t count) {
    WaitUntil(name, [&] {
      const std::lock_guard guard(lock);
      return lines.size() >= count;
    });
  }
  void Tell() {
    const std::lock_guard guard(lock);
    for (const std::string& line : lines) Event("%s: %s", name, line.c_str());
  }

  const char* name;
  std::mutex lock;
  std::vector<std::string> lines;
};

void TakeInto(Log& log, dds_entity_t reader) {
  for (const auto& [sample, info] : All(reader)) {
    log.Add("data " + std::to_string(sample.key) + ": " +
            (info.valid_data ? std::to_string(sample.value) : "none"));
  }
}

void DataAvailable(dds_entity_t reader, void* log) { TakeInto(*static_cast<Log*>(log), reader); }

void DataOnReaders(dds_entity_t subscriber, void* log) {
  dds_entity_t readers[4];
  const int count = OK(dds_get_children(subscriber, readers, 4));
  for (int i = 0; i < count; i++) TakeInto(*static_cast<Log*>(log), readers[i]);
}

std::string Counts(std::uint32_t current, std::int32_t change, std::uint32_t total) {
  return "matched " + std::to_string(current) + " (" + (change > 0 ? "+" : "") +
         std::to_string(change) + ") of " + std::to_string(total);
}

void SubscriptionMatched(dds_entity_t, const dds_subscription_matched_status_t s, void* log) {
  static_cast<Log*>(log)->Add(Counts(s.current_count, s.current_count_change, s.total_count));
}

void PublicationMatched(dds_entity_t, const dds_publication_matched_status_t s, void* log) {
  static_cast<Log*>(log)->Add(Counts(s.current_count, s.current_count_change, s.total_count));
}

void Writer(Process& self) {
  Log log("writer of a");
  dds_listener_t* listener = dds_create_listener(&log);
  dds_lset_publication_matched(listener, PublicationMatched);
  const dds_entity_t a =
      OK(dds_create_writer(self.participant, self.Topic("a"), Plain().get(), listener));
  dds_delete_listener(listener);
  const dds_entity_t b = self.Writer(self.Topic("b")), c = self.Writer(self.Topic("c"));
  log.WaitFor(1);
  WaitForReaders(b, 1);
  WaitForReaders(c, 1);
  self.peer.Meet("matched");
  for (int value = 1; value <= 3; value++) {
    for (const dds_entity_t writer : {a, b, c}) Write(writer, 1, value);
  }
  self.peer.Await("all data seen");
  OK(dds_delete(c));
  self.peer.Await("reader deleted");
  log.WaitFor(2);
  log.Tell();
}

void Reader(Process& self) {
  Log of_a("reader of a"), of_b("subscriber of b"), of_all("participant");
  dds_listener_t* listener = dds_create_listener(&of_a);
  dds_lset_data_available(listener, DataAvailable);
  dds_lset_subscription_matched(listener, SubscriptionMatched);
  const dds_entity_t a =
      OK(dds_create_reader(self.participant, self.Topic("a"), Plain().get(), listener));
  dds_delete_listener(listener);

  listener = dds_create_listener(&of_b);
  dds_lset_data_on_readers(listener, DataOnReaders);
  const dds_entity_t subscriber = OK(dds_create_subscriber(self.participant, nullptr, listener));
  dds_delete_listener(listener);
  const dds_entity_t b = OK(dds_create_reader(subscriber, self.Topic("b"), Plain().get(), nullptr));

  listener = dds_create_listener(&of_all);
  dds_lset_data_available(listener, DataAvailable);
  OK(dds_set_listener(self.participant, listener));
  dds_delete_listener(listener);
  const dds_entity_t c = self.Reader(self.Topic("c"));

  of_a.WaitFor(1);
  WaitForWriters(b, 1);
  WaitForWriters(c, 1);
  self.peer.Meet("matched");
  of_a.WaitFor(4);
  of_b.WaitFor(3);
  of_all.WaitFor(3);
  self.peer.Reached("all data seen");
  // That the writer of c has gone is data, too.
  of_all.WaitFor(4);
  OK(dds_delete(a));
  self.peer.Reached("reader deleted");
  // The other process may be gone first, which is data as well.
  for (const dds_entity_t with : {self.participant, subscriber}) {
    OK(dds_set_listener(with, nullptr));
  }
  for (Log* log : {&of_a, &of_b, &of_all}) log->Tell();
}

}  // namespace

TCS_DDS_SCENARIO(listeners, Writer, Reader);
