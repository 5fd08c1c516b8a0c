// A waitset of a read condition, a guard condition and a reader's status: each wait returns what
// triggers, and nothing when its time is over.
#include <algorithm>
#include <string>
#include <vector>

#include "tests/dds/support/process.h"
#include "tests/dds/support/samples.h"

namespace {

using namespace dds_test;

void Writer(Process& self) {
  self.peer.Await("nothing triggers");
  const dds_entity_t writer = self.Writer(self.Topic());
  WaitForReaders(writer, 1);
  self.peer.Meet("matched");
  Write(writer, 1, 1);
  self.peer.Await("data told");
}

constexpr dds_attach_t kStatus = 1, kData = 2, kGuard = 3, kItself = 4;

const char* Name(dds_attach_t what) {
  const char* const names[] = {"?", "status ", "data ", "guard ", "itself "};
  return names[what];
}

void Wait(const char* when, dds_entity_t set, dds_duration_t timeout) {
  std::vector<dds_attach_t> what(8);
  const int count = OK(dds_waitset_wait(set, what.data(), what.size(), timeout));
  what.resize(static_cast<std::size_t>(count));
  std::sort(what.begin(), what.end());
  std::string names;
  for (const dds_attach_t w : what) names += Name(w);
  Event("%s: %d %s", when, count, names.c_str());
}

void Reader(Process& self) {
  const dds_entity_t reader = self.Reader(self.Topic());
  const dds_entity_t data = OK(dds_create_readcondition(reader, DDS_NOT_READ_SAMPLE_STATE));
  const dds_entity_t guard = OK(dds_create_guardcondition(self.participant));
  const dds_entity_t set = OK(dds_create_waitset(self.participant));
  OK(dds_set_status_mask(reader, DDS_SUBSCRIPTION_MATCHED_STATUS));
  OK(dds_waitset_attach(set, reader, kStatus));
  OK(dds_waitset_attach(set, data, kData));
  OK(dds_waitset_attach(set, guard, kGuard));
  Event("attached twice: %s", Code(dds_waitset_attach(set, guard, kGuard)));
  dds_entity_t entities[8];
  Event("entities: %d", OK(dds_waitset_get_entities(set, entities, 8)));

  const dds_time_t start = dds_time();
  Wait("10 ms", set, DDS_MSECS(10));
  if (dds_time() < start + DDS_MSECS(10)) Fail("a wait of 10 ms was early");
  Event("until now: %d", OK(dds_waitset_wait_until(set, nullptr, 0, dds_time())));
  self.peer.Reached("nothing triggers");

  Wait("a writer comes", set, kPatience);
  dds_subscription_matched_status_t status;
  OK(dds_get_subscription_matched_status(reader, &status));
  self.peer.Meet("matched");
  Wait("data come", set, kPatience);
  OK(dds_set_guardcondition(guard, true));
  Wait("the guard is set", set, kPatience);
  TakeAndTell(reader, "taken");
  Wait("data taken", set, kPatience);
  OK(dds_set_guardcondition(guard, false));
  Wait("the guard is reset", set, 0);

  OK(dds_waitset_attach(set, set, kItself));
  OK(dds_waitset_set_trigger(set, true));
  Wait("itself triggered", set, kPatience);
  OK(dds_waitset_set_trigger(set, false));
  OK(dds_waitset_detach(set, guard));
  Event("detached twice: %s", Code(dds_waitset_detach(set, guard)));
  OK(dds_set_guardcondition(guard, true));
  Wait("the guard is detached", set, 0);
  self.peer.Reached("data told");
}

}  // namespace

TCS_DDS_SCENARIO(waitsets, Writer, Reader);
