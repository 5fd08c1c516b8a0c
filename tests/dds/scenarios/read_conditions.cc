// Read conditions select by the states of samples, views and instances; they trigger while there is
// something to select.
#include "tests/dds/support/process.h"
#include "tests/dds/support/samples.h"

namespace {

using namespace dds_test;

void Writer(Process& self) {
  const dds_entity_t writer = self.Writer(self.Topic());
  WaitForReaders(writer, 1);
  self.peer.Meet("matched");
  Write(writer, 1, 1);
  Write(writer, 2, 2);
  Write(writer, 90, 0);
  self.peer.Await("read");
  Write(writer, 2, 3);
  Write(writer, 3, 4);
  const dds_test_Sample one{1, 0};
  OK(dds_dispose(writer, &one));
  Write(writer, 91, 0);
}

void Reader(Process& self) {
  const dds_entity_t reader = self.Reader(self.Topic());
  struct {
    const char* name;
    std::uint32_t mask;
    dds_entity_t condition;
  } conditions[] = {
      {"not read", DDS_NOT_READ_SAMPLE_STATE | DDS_ANY_VIEW_STATE | DDS_ANY_INSTANCE_STATE, 0},
      {"read", DDS_READ_SAMPLE_STATE | DDS_ANY_VIEW_STATE | DDS_ANY_INSTANCE_STATE, 0},
      {"new", DDS_ANY_SAMPLE_STATE | DDS_NEW_VIEW_STATE | DDS_ANY_INSTANCE_STATE, 0},
      {"disposed",
       DDS_ANY_SAMPLE_STATE | DDS_ANY_VIEW_STATE | DDS_NOT_ALIVE_DISPOSED_INSTANCE_STATE, 0},
  };
  for (auto& c : conditions) c.condition = OK(dds_create_readcondition(reader, c.mask));
  const auto tell = [&](const char* when) {
    for (const auto& c : conditions)
      Event("%s: '%s' %s", when, c.name, OK(dds_triggered(c.condition)) ? "triggers" : "is quiet");
  };
  tell("empty");
  WaitForWriters(reader, 1);
  self.peer.Meet("matched");
  WaitForSample<90>(reader);
  tell("written");
  Tell("not read", All(conditions[0].condition, How::kRead));
  tell("read");
  self.peer.Reached("read");
  WaitForSample<91>(reader);
  tell("written again");
  Tell("disposed", All(conditions[3].condition));
  Tell("new", All(conditions[2].condition));
  Tell("read", All(conditions[1].condition));
  Tell("not read", All(conditions[0].condition));
  tell("taken");
}

}  // namespace

TCS_DDS_SCENARIO(read_conditions, Writer, Reader);
