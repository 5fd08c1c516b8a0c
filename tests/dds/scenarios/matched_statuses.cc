// The counts and changes of the matched statuses while readers come and go, and the handles of
// those that are there.
#include "tests/dds/support/process.h"
#include "tests/dds/support/samples.h"

namespace {

using namespace dds_test;

void Tell(const char* when, std::uint32_t total, std::int32_t total_change, std::uint32_t current,
          std::int32_t current_change) {
  Event("%s: %u (%+d) ever, %u (%+d) now", when, total, total_change, current, current_change);
}

void Writer(Process& self) {
  const dds_entity_t writer = self.Writer(self.Topic());
  const auto tell = [&](const char* when) {
    self.peer.Await(when);
    dds_publication_matched_status_t s;
    std::int32_t total_change = 0, current_change = 0;
    const std::uint32_t wanted = self.peer.Receive<std::uint32_t>();
    // Reading resets the changes: they are added up until all is there.
    WaitForStatus(writer, DDS_PUBLICATION_MATCHED_STATUS, [&] {
      OK(dds_get_publication_matched_status(writer, &s));
      total_change += s.total_count_change;
      current_change += s.current_count_change;
      return s.current_count == wanted;
    });
    Tell(when, s.total_count, total_change, s.current_count, current_change);
    dds_instance_handle_t handles[4];
    const int count = OK(dds_get_matched_subscriptions(writer, handles, 4));
    bool last_is_there = false;
    for (int i = 0; i < count; i++) last_is_there |= handles[i] == s.last_subscription_handle;
    Event("%s: %d handles, the last one is %s", when, count,
          last_is_there ? "among them" : "not among them");
    OK(dds_get_publication_matched_status(writer, &s));
    Tell("read again", s.total_count, s.total_count_change, s.current_count,
         s.current_count_change);
    self.peer.Reached("told");
  };
  tell("one");
  tell("two");
  tell("one again");
  tell("none");
  tell("a third");
}

void Reader(Process& self) {
  const dds_entity_t topic = self.Topic();
  const auto step = [&](const char* name, std::uint32_t readers) {
    self.peer.Reached(name);
    self.peer.Send(readers);
    self.peer.Await("told");
  };
  const dds_entity_t first = self.Reader(topic);
  WaitForWriters(first, 1);
  step("one", 1);
  const dds_entity_t second = self.Reader(topic);
  WaitForWriters(second, 1);
  step("two", 2);
  OK(dds_delete(second));
  step("one again", 1);
  OK(dds_delete(first));
  step("none", 0);
  const dds_entity_t third = self.Reader(topic);
  dds_subscription_matched_status_t s;
  WaitForStatus(third, DDS_SUBSCRIPTION_MATCHED_STATUS, [&] {
    OK(dds_get_subscription_matched_status(third, &s));
    return s.current_count == 1;
  });
  Tell("the third", s.total_count, s.total_count_change, s.current_count, s.current_count_change);
  step("a third", 1);
}

}  // namespace

TCS_DDS_SCENARIO(matched_statuses, Writer, Reader);
