// A filter set on the reader's topic keeps samples out of its cache; the reader beside it, on a
// topic of its own, gets everything.
#include "tests/dds/support/process.h"
#include "tests/dds/support/samples.h"

namespace {

using namespace dds_test;

void Writer(Process& self) {
  const dds_entity_t writer = self.Writer(self.Topic());
  WaitForReaders(writer, 2);
  self.peer.Meet("matched");
  for (int value = 1; value <= 6; value++) Write(writer, value % 2, value);
  Write(writer, 90, 0);
}

bool AboveOrMarker(const void* sample, void* limit) {
  const auto& s = *static_cast<const dds_test_Sample*>(sample);
  return s.value > *static_cast<const int*>(limit) || s.key >= kMarkers;
}

void Reader(Process& self) {
  int limit = 3;
  const dds_entity_t filtered_topic = self.Topic();
  OK(dds_set_topic_filter_and_arg(filtered_topic, AboveOrMarker, &limit));
  const dds_entity_t filtered = self.Reader(filtered_topic), whole = self.Reader(self.Topic());
  WaitForWriters(filtered, 1);
  WaitForWriters(whole, 1);
  self.peer.Meet("matched");
  WaitForSample<90>(filtered);
  WaitForSample<90>(whole);
  TakeAndTell(filtered, "filtered");
  TakeAndTell(whole, "whole");
}

}  // namespace

TCS_DDS_SCENARIO(topic_filters, Writer, Reader);
