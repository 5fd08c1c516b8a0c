// A guard condition, set by another thread and by a listener, wakes who waits for it.
#include <atomic>
#include <thread>

#include "tests/dds/support/process.h"
#include "tests/dds/support/samples.h"

namespace {

using namespace dds_test;

void Writer(Process& self) {
  const dds_entity_t writer = self.Writer(self.Topic());
  WaitForReaders(writer, 1);
  self.peer.Meet("matched");
  self.peer.Await("asked");
  Write(writer, 1, 1);
}

std::atomic<dds_entity_t> g_guard;

void Set(dds_entity_t, void*) { OK(dds_set_guardcondition(g_guard, true)); }

void Reader(Process& self) {
  const dds_entity_t guard = OK(dds_create_guardcondition(self.participant));
  g_guard = guard;
  const dds_entity_t set = OK(dds_create_waitset(self.participant));
  OK(dds_waitset_attach(set, guard, 1));
  bool value;
  OK(dds_read_guardcondition(guard, &value));
  Event("at first: %d", value);

  std::thread setter([&] {
    dds_sleepfor(DDS_MSECS(20));
    Set(0, nullptr);
  });
  Event("set by a thread: %d", OK(dds_waitset_wait(set, nullptr, 0, kPatience)));
  setter.join();
  OK(dds_read_guardcondition(guard, &value));
  Event("read: %d", value);
  OK(dds_take_guardcondition(guard, &value));
  Event("taken: %d", value);
  OK(dds_read_guardcondition(guard, &value));
  Event("then: %d", value);
  Event("waited for in vain: %d", OK(dds_waitset_wait(set, nullptr, 0, DDS_MSECS(10))));

  dds_listener_t* listener = dds_create_listener(nullptr);
  dds_lset_data_available(listener, Set);
  const dds_entity_t reader =
      OK(dds_create_reader(self.participant, self.Topic(), Plain().get(), listener));
  dds_delete_listener(listener);
  WaitForWriters(reader, 1);
  self.peer.Meet("matched");
  self.peer.Reached("asked");
  Event("set by a listener: %d", OK(dds_waitset_wait(set, nullptr, 0, kPatience)));
  TakeAndTell(reader, "reader");
}

}  // namespace

TCS_DDS_SCENARIO(guard_conditions, Writer, Reader);
