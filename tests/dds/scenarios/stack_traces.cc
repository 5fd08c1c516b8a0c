// A program has Cyclone log the stacks of all threads that it knows, as its watchdog
// (Internal/LivelinessMonitoring) does: each of them answers, tcs's own among them.
#include <dds/ddsi/q_thread.h>
#include <stdio.h>

#include <memory>

#include "tests/dds/support/process.h"
#include "tests/dds/support/samples.h"

namespace {

using namespace dds_test;

void LogStackTraces() {
  const std::unique_ptr<FILE, int (*)(FILE*)> nowhere(fopen("/dev/null", "w"), fclose);
  ddsrt_log_cfg_t log;
  dds_log_cfg_init(&log, 0, ~0u, nowhere.get(), nowhere.get());
  log_stack_traces(&log, nullptr);
  Event("all threads have answered");
}

void Writer(Process& self) {
  const dds_entity_t writer = self.Writer(self.Topic());
  WaitForReaders(writer, 1);
  self.peer.Meet("matched");
  LogStackTraces();
  Write(writer, 1, 1);
  self.peer.Meet("told");
}

void Reader(Process& self) {
  const dds_entity_t reader = self.Reader(self.Topic());
  WaitForWriters(reader, 1);
  self.peer.Meet("matched");
  WaitForSample<1>(reader);
  LogStackTraces();
  TakeAndTell(reader, "reader");
  self.peer.Meet("told");
}

}  // namespace

TCS_DDS_SCENARIO(stack_traces, Writer, Reader);
