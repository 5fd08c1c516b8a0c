// A relay in the other process takes serialized samples and forwards them as they are: values,
// disposes, unregistrations and source timestamps come back unchanged.
#include <dds/ddsi/ddsi_serdata.h>

#include "tests/dds/support/process.h"
#include "tests/dds/support/samples.h"

namespace {

using namespace dds_test;

void Writer(Process& self) {
  const dds_entity_t writer = self.Writer(self.Topic("out"), Plain().UnregisterDoesNotDispose());
  const dds_entity_t reader = self.Reader(self.Topic("back"));
  WaitForReaders(writer, 1);
  WaitForWriters(reader, 1);
  self.peer.Meet("matched");
  constexpr dds_time_t kStart = DDS_SECS(1'000'000'000);
  const auto write_at = [&](int key, int value, int ms) {
    const dds_test_Sample sample{key, value};
    OK(dds_write_ts(writer, &sample, kStart + DDS_MSECS(ms)));
  };
  const dds_test_Sample one{1, 0}, two{2, 22}, three{3, 0};
  write_at(1, 10, 1);
  write_at(1, 11, 2);
  write_at(2, 20, 3);
  write_at(3, 30, 4);
  write_at(90, 0, 5);
  WaitForSample<90>(reader);
  const auto tell = [&](const char* when) {
    const std::vector<Received> samples = All(reader);
    Tell(when, samples);
    for (const auto& [sample, info] : samples) {
      if (sample.key < kMarkers)
        Event("%d: written at %lld ms", sample.key,
              static_cast<long long>((info.source_timestamp - kStart) / DDS_NSECS_IN_MSEC));
    }
  };
  tell("written");
  OK(dds_dispose_ts(writer, &one, kStart + DDS_MSECS(6)));
  OK(dds_writedispose_ts(writer, &two, kStart + DDS_MSECS(7)));
  OK(dds_unregister_instance_ts(writer, &three, kStart + DDS_MSECS(8)));
  write_at(91, 0, 9);
  WaitForSample<91>(reader);
  tell("disposed and unregistered");
  self.peer.Reached("done");
}

// Where an instance only changed its state there is a key to take, and nothing to forward.
void Forward(dds_entity_t writer, ddsi_serdata* serialized, const dds_sample_info_t& info,
             const dds_test_Sample& key) {
  if (info.valid_data) {
    OK(dds_forwardcdr(writer, serialized));
    return;
  }
  ddsi_serdata_unref(serialized);
  OK(info.instance_state == DDS_IST_NOT_ALIVE_DISPOSED
         ? dds_dispose_ts(writer, &key, info.source_timestamp)
         : dds_unregister_instance_ts(writer, &key, info.source_timestamp));
}

void Relay(Process& self) {
  const dds_entity_t reader = self.Reader(self.Topic("out"));
  const dds_entity_t writer = self.Writer(self.Topic("back"), Plain().UnregisterDoesNotDispose());
  WaitForWriters(reader, 1);
  WaitForReaders(writer, 1);
  self.peer.Meet("matched");
  // Until the last marker has passed; the states of what is taken depend on how much is there at
  // once, what is forwarded does not.
  bool last = false;
  int forwarded = 0;
  while (!last) {
    WaitForState(reader, DDS_ANY_STATE);
    ddsi_serdata* samples[16];
    dds_sample_info_t infos[16];
    const int count = OK(dds_takecdr(reader, samples, 16, infos, DDS_ANY_STATE));
    for (int i = 0; i < count; i++) {
      dds_test_Sample key{};
      OK(dds_instance_get_key(reader, infos[i].instance_handle, &key));
      last = last || key.key == 91;
      forwarded++;
      Forward(writer, samples[i], infos[i], key);
    }
  }
  Event("forwarded: %d", forwarded);
  self.peer.Await("done");
}

}  // namespace

TCS_DDS_SCENARIO(forwarded_cdr, Writer, Relay);
