// A program is stopped by a signal for longer than its participant's lease: its writer is gone for
// the others. When it goes on they find each other again, and its samples come.
#include <signal.h>
#include <unistd.h>

#include "tests/dds/support/process.h"
#include "tests/dds/support/samples.h"

namespace {

using namespace dds_test;

dds_entity_t ShortLived(Process& self) {
  self.UseShortLease("1s");
  return self.Topic();
}

void Writer(Process& self) {
  const dds_entity_t writer = self.Writer(ShortLived(self));
  WaitForReaders(writer, 1);
  self.peer.Meet("matched");
  self.peer.Send(getpid());
  raise(SIGSTOP);
  self.peer.Await("found again");
  // Until it has found the reader again, too.
  for (int i = 0; i < 60; i++) {
    Write(writer, 1, i);
    dds_sleepfor(DDS_MSECS(50));
  }
  self.peer.Await("received");
}

void Reader(Process& self) {
  const dds_entity_t reader = self.Reader(ShortLived(self));
  WaitForWriters(reader, 1);
  self.peer.Meet("matched");
  const pid_t writer = self.peer.Receive<pid_t>();
  WaitForWriters(reader, 0);
  Event("there is no writer");
  if (kill(writer, SIGCONT) != 0) Fail("the writer cannot be continued");
  WaitForWriters(reader, 1);
  Event("there is one again");
  self.peer.Reached("found again");
  WaitForSample<1>(reader);
  Event("its samples come");
  self.peer.Reached("received");
}

}  // namespace

TCS_DDS_SCENARIO(stopped_for_long, Writer, Reader);
