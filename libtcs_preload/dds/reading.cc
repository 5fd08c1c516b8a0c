#include "libtcs_preload/dds/reading.h"

#include <algorithm>
#include <string_view>
#include <type_traits>

#include "libtcs_preload/dds/cyclone.h"
#include "libtcs_preload/dds/deliverer.h"
#include "libtcs_preload/dds/listening.h"
#include "libtcs_preload/dds/outgoing.h"

namespace tcs::dds {
namespace {

thread_local bool t_reading;

// Reading calls may call each other inside Cyclone. A listener that reads has been called because
// there is something, and must not wait for the deliverer (listening.h).
class Reading {
 public:
  Reading() : outermost_(!t_reading) {
    if (outermost_ && !IsDeliverer() && !IsListening()) TheLink().sync();
    t_reading = true;
  }
  ~Reading() {
    if (outermost_) t_reading = false;
  }
  bool outermost() const { return outermost_; }
  Reading(const Reading&) = delete;
  Reading& operator=(const Reading&) = delete;

 private:
  bool outermost_;
};

template <class First, class... Others>
const dds_sample_info_t* InfosOf(First first, Others... others) {
  if constexpr (std::is_same_v<First, dds_sample_info_t*>) {
    return first;
  } else {
    return InfosOf(others...);
  }
}

// The samples lie in memory that all of the program's threads share, and a thread on another core
// may have put them there at a time that the caller has not come to yet: the caller goes on when it
// has. A sample that is further ahead has a timestamp of its writer's making. The deliverer goes
// on: others wait for what else the deliverer has.
void AwaitWrites(const dds_sample_info_t* infos, dds_return_t count) {
  const std::int64_t most = TheLink().behind_ns();
  if (most == 0 || IsDeliverer()) return;
  dds_time_t latest = 0;
  for (dds_return_t i = 0; i < count; ++i) {
    latest = std::max(latest, infos[i].source_timestamp);
  }
  const dds_duration_t ahead = latest - dds_time();
  if (ahead > 0 && ahead <= most) dds_sleepfor(ahead);
}

template <class First, class... Others>
dds_entity_t FirstOf(First first, Others...) {
  return static_cast<dds_entity_t>(first);
}

void Tell(const dds_sample_info_t* infos, dds_return_t count, dds_entity_t reader) {
  shm::TakenSamples samples{.oldest_ns = infos[0].source_timestamp,
                            .newest_ns = infos[0].source_timestamp,
                            .reader = reader,
                            .padding = 0};
  for (dds_return_t i = 1; i < count; ++i) {
    samples.oldest_ns = std::min<std::int64_t>(samples.oldest_ns, infos[i].source_timestamp);
    samples.newest_ns = std::max<std::int64_t>(samples.newest_ns, infos[i].source_timestamp);
  }
  TheLink().taken(samples);
}

template <auto RealCalls::*kCall, bool kTakes, class Function>
struct HookedRead;

template <auto RealCalls::*kCall, bool kTakes, class Result, class... Arguments>
struct HookedRead<kCall, kTakes, Result (*)(Arguments...)> {
  static Result Do(Arguments... arguments) {
    const Reading reading;
    const Result result = (Real().*kCall)(arguments...);
    if constexpr ((std::is_same_v<Arguments, dds_sample_info_t*> || ...)) {
      if (result > 0) {
        AwaitWrites(InfosOf(arguments...), static_cast<dds_return_t>(result));
        if (kTakes && reading.outermost()) {
          Tell(InfosOf(arguments...), static_cast<dds_return_t>(result), FirstOf(arguments...));
        }
      }
    }
    return result;
  }
};

// Samples that are only read are there again the next time.
constexpr bool IsTake(std::string_view name) { return name.find("take") != std::string_view::npos; }

}  // namespace

void* ReadingHook(Call call) {
  switch (call) {
#define TCS_DDS_HOOK(name)          \
  case kCall_##name:                \
    return reinterpret_cast<void*>( \
        HookedRead<&RealCalls::name, IsTake(#name), decltype(RealCalls::name)>::Do);
    TCS_DDS_READING_CALLS(TCS_DDS_HOOK)
#undef TCS_DDS_HOOK
    default:
      return nullptr;
  }
}

}  // namespace tcs::dds
