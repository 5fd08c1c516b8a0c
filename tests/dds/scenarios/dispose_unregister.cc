// The life of an instance: what each of write, dispose, writedispose and unregister does to its
// state, its view and its generations.
#include "tests/dds/support/process.h"
#include "tests/dds/support/samples.h"

namespace {

using namespace dds_test;

struct Step {
  const char* name;
  void (*act)(dds_entity_t writer);
};

constexpr dds_test_Sample kOne{1, 0};

const Step kSteps[] = {
    {"write", [](dds_entity_t writer) { Write(writer, 1, 1); }},
    {"write twice",
     [](dds_entity_t writer) {
       Write(writer, 1, 2);
       Write(writer, 1, 3);
     }},
    {"dispose", [](dds_entity_t writer) { OK(dds_dispose(writer, &kOne)); }},
    {"dispose again", [](dds_entity_t writer) { OK(dds_dispose(writer, &kOne)); }},
    {"write after dispose", [](dds_entity_t writer) { Write(writer, 1, 4); }},
    {"unregister", [](dds_entity_t writer) { OK(dds_unregister_instance(writer, &kOne)); }},
    {"write after unregister", [](dds_entity_t writer) { Write(writer, 1, 5); }},
    {"writedispose",
     [](dds_entity_t writer) {
       const dds_test_Sample last{1, 6};
       OK(dds_writedispose(writer, &last));
     }},
    {"write, dispose, write",
     [](dds_entity_t writer) {
       Write(writer, 1, 7);
       OK(dds_dispose(writer, &kOne));
       Write(writer, 1, 8);
     }},
    {"dispose and unregister",
     [](dds_entity_t writer) {
       OK(dds_dispose(writer, &kOne));
       OK(dds_unregister_instance(writer, &kOne));
     }},
    {"by handle",
     [](dds_entity_t writer) {
       Write(writer, 1, 9);
       const dds_instance_handle_t handle = dds_lookup_instance(writer, &kOne);
       OK(dds_dispose_ih(writer, handle));
       OK(dds_unregister_instance_ih(writer, handle));
     }},
};

// The markers are of a writer's own instances, so that they change nothing of the one looked at.
void Writer(Process& self) {
  const dds_entity_t topic = self.Topic();
  const dds_entity_t writer = self.Writer(topic, Plain().UnregisterDoesNotDispose());
  WaitForReaders(writer, 2);
  self.peer.Meet("matched");
  for (const Step& step : kSteps) {
    step.act(writer);
    Write(writer, 90, 0);
    self.peer.Await(step.name);
  }
}

void Reader(Process& self) {
  const dds_entity_t topic = self.Topic();
  // One takes after each step, the other one only looks on.
  const dds_entity_t taking = self.Reader(topic), looking = self.Reader(topic);
  WaitForWriters(taking, 1);
  WaitForWriters(looking, 1);
  self.peer.Meet("matched");
  for (const Step& step : kSteps) {
    WaitForSample<90>(taking);
    WaitUntil("the marker is there", [&] {
      for (const auto& [sample, info] : All(looking, How::kRead)) {
        if (sample.key == 90 && info.sample_state == DDS_SST_NOT_READ) return true;
      }
      return false;
    });
    TakeAndTell(taking, step.name);
    self.peer.Reached(step.name);
  }
  TakeAndTell(looking, "all of it");
}

}  // namespace

TCS_DDS_SCENARIO(dispose_unregister, Writer, Reader);
