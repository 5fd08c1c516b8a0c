// A writer's program is stopped by a signal: when its lease is over the reader sees the writer not
// alive, and its instance without writers. When the program goes on and writes, both are alive
// again.
#include <signal.h>
#include <unistd.h>

#include "tests/dds/support/process.h"
#include "tests/dds/support/samples.h"
#include "tests/dds/support/timing.h"

namespace {

using namespace dds_test;

constexpr dds_duration_t kLease = DDS_MSECS(500);

void Writer(Process& self) {
  const dds_entity_t writer = self.Writer(self.Topic(), Leased(kLease).UnregisterDoesNotDispose());
  WaitForReaders(writer, 1);
  self.peer.Meet("matched");
  Write(writer, 1, 1);
  self.peer.Await("received");
  self.peer.Send(getpid());
  raise(SIGSTOP);
  Write(writer, 1, 2);
  self.peer.Await("received again");
}

void WaitForAlive(dds_entity_t reader, std::uint32_t alive, std::uint32_t not_alive) {
  WaitForStatus(reader, DDS_LIVELINESS_CHANGED_STATUS, [=] {
    dds_liveliness_changed_status_t status;
    OK(dds_get_liveliness_changed_status(reader, &status));
    return status.alive_count == alive && status.not_alive_count == not_alive;
  });
  Event("%u alive, %u not alive", alive, not_alive);
}

void Reader(Process& self) {
  const dds_entity_t reader = self.Reader(self.Topic(), Leased(kLease));
  WaitForWriters(reader, 1);
  self.peer.Meet("matched");
  WaitForSample<1>(reader);
  TakeAndTell(reader, "reader");
  WaitForAlive(reader, 1, 0);
  self.peer.Reached("received");
  const pid_t writer = self.peer.Receive<pid_t>();
  WaitForAlive(reader, 0, 1);
  TakeAndTell(reader, "stopped");
  if (kill(writer, SIGCONT) != 0) Fail("the writer cannot be continued");
  WaitForAlive(reader, 1, 0);
  WaitForState(reader, DDS_ANY_SAMPLE_STATE | DDS_ANY_VIEW_STATE | DDS_ALIVE_INSTANCE_STATE);
  TakeAndTell(reader, "continued");
  self.peer.Reached("received again");
}

}  // namespace

TCS_DDS_SCENARIO(stopped_writer, Writer, Reader);
