#include "tests/dds/support/samples.h"

#include <algorithm>
#include <map>
#include <string>

namespace dds_test {

namespace {

constexpr int kMost = 256;

const char* Instance(dds_instance_state_t state) {
  if (state == DDS_IST_ALIVE) return "alive";
  return state == DDS_IST_NOT_ALIVE_DISPOSED ? "disposed" : "no writers";
}

void CheckOrder(const std::vector<Received>& samples) {
  std::map<std::pair<dds_instance_handle_t, int>, dds_time_t> last;
  for (const Received& r : samples) {
    dds_time_t& before = last[{r.info.publication_handle, r.sample.key}];
    if (r.info.source_timestamp < before)
      Fail("a sample of key %d is older than the one before it", r.sample.key);
    before = r.info.source_timestamp;
  }
}

}  // namespace

std::vector<Received> All(dds_entity_t from, How how) {
  void* samples[kMost] = {};
  dds_sample_info_t infos[kMost];
  const int count = OK(how == How::kTake ? dds_take(from, samples, infos, kMost, kMost)
                                         : dds_read(from, samples, infos, kMost, kMost));
  std::vector<Received> all;
  for (int i = 0; i < count; i++)
    all.push_back({*static_cast<const dds_test_Sample*>(samples[i]), infos[i]});
  if (count > 0) OK(dds_return_loan(from, samples, count));
  CheckOrder(all);
  std::stable_sort(all.begin(), all.end(), [](const Received& a, const Received& b) {
    return a.sample.key < b.sample.key;
  });
  return all;
}

void Tell(const char* who, const std::vector<Received>& samples) {
  bool any = false;
  for (const auto& [sample, info] : samples) {
    if (sample.key >= kMarkers) continue;
    any = true;
    const std::string value = info.valid_data ? std::to_string(sample.value) : "no data";
    std::string generations;
    if (info.disposed_generation_count + info.no_writers_generation_count > 0) {
      generations = ", generations " + std::to_string(info.disposed_generation_count) + " + " +
                    std::to_string(info.no_writers_generation_count);
    }
    Event("%s: %d: %s, %s, %s%s%s", who, sample.key, value.c_str(), Instance(info.instance_state),
          info.view_state == DDS_VST_NEW ? "new" : "known",
          info.sample_state == DDS_SST_READ ? ", read before" : "", generations.c_str());
  }
  if (!any) Event("%s: nothing", who);
}

}  // namespace dds_test
