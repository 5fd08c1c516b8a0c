// Instances by their handles, at the writer and at the reader: registering, looking up, keys,
// reading and taking one of several, and what is refused.
#include "tests/dds/support/process.h"
#include "tests/dds/support/samples.h"

namespace {

using namespace dds_test;

int KeyOf(dds_entity_t entity, dds_instance_handle_t handle) {
  dds_test_Sample sample{};
  OK(dds_instance_get_key(entity, handle, &sample));
  return sample.key;
}

void Writer(Process& self) {
  const dds_entity_t writer = self.Writer(self.Topic());
  WaitForReaders(writer, 1);
  self.peer.Meet("matched");
  const dds_test_Sample one{1, 0}, two{2, 0}, five{5, 0};
  dds_instance_handle_t first, again;
  OK(dds_register_instance(writer, &first, &one));
  OK(dds_register_instance(writer, &again, &one));
  Event("registered twice: %s", first == again ? "the same" : "another");
  Event("looked up: %s", dds_lookup_instance(writer, &one) == first ? "the same" : "another");
  Event("its key: %d", KeyOf(writer, first));
  Event("never registered: %s",
        dds_lookup_instance(writer, &five) == DDS_HANDLE_NIL ? "no handle" : "a handle");
  for (int value = 1; value <= 2; value++) {
    for (int key = 1; key <= 3; key++) Write(writer, key, 10 * key + value);
  }
  Event("written: %s",
        dds_lookup_instance(writer, &two) == DDS_HANDLE_NIL ? "no handle" : "a handle");
  Event("dispose of no handle: %s", Code(dds_dispose_ih(writer, DDS_HANDLE_NIL)));
  Event("unregister of an unknown handle: %s", Code(dds_unregister_instance_ih(writer, 12345)));
  Write(writer, 90, 0);
}

int Count(dds_return_t got, dds_entity_t reader, void** samples) {
  if (got > 0) OK(dds_return_loan(reader, samples, got));
  return got;
}

void Reader(Process& self) {
  const dds_entity_t reader = self.Reader(self.Topic());
  WaitForWriters(reader, 1);
  self.peer.Meet("matched");
  WaitForSample<90>(reader);
  const dds_test_Sample two{2, 0}, three{3, 0}, six{6, 0};
  const dds_instance_handle_t second = dds_lookup_instance(reader, &two);
  Event("looked up: %s", second == DDS_HANDLE_NIL ? "no handle" : "a handle");
  Event("its key: %d", KeyOf(reader, second));
  Event("never seen: %s",
        dds_lookup_instance(reader, &six) == DDS_HANDLE_NIL ? "no handle" : "a handle");

  void* samples[8] = {};
  dds_sample_info_t infos[8];
  Event("read of 2: %d",
        Count(OK(dds_read_instance(reader, samples, infos, 8, 8, second)), reader, samples));
  Event("handles agree: %s", infos[0].instance_handle == second ? "yes" : "no");
  samples[0] = nullptr;
  Event("take of one of 2: %d",
        Count(OK(dds_take_instance(reader, samples, infos, 8, 1, second)), reader, samples));
  samples[0] = nullptr;
  Event("take of the rest of 2: %d",
        Count(OK(dds_take_instance(reader, samples, infos, 8, 8, second)), reader, samples));
  samples[0] = nullptr;
  Event("take of none of 2: %d",
        Count(OK(dds_take_instance(reader, samples, infos, 8, 8, second)), reader, samples));
  samples[0] = nullptr;
  Event("take of an unknown handle: %s",
        Code(dds_take_instance(reader, samples, infos, 8, 8, 12345)));
  const dds_instance_handle_t third = dds_lookup_instance(reader, &three);
  samples[0] = nullptr;
  Event("read of 3 that was read before: %d",
        Count(OK(dds_read_instance_mask(
                  reader, samples, infos, 8, 8, third,
                  DDS_READ_SAMPLE_STATE | DDS_ANY_VIEW_STATE | DDS_ANY_INSTANCE_STATE)),
              reader, samples));
  samples[0] = nullptr;
  int next = 0;
  for (; Count(OK(dds_take_next(reader, samples, infos)), reader, samples) > 0; next++)
    samples[0] = nullptr;
  Event("taken one by one: %d", next);
}

}  // namespace

TCS_DDS_SCENARIO(instance_lookups, Writer, Reader);
