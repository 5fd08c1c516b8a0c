#include "libtcs_preload/dds/reading.h"

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
  Reading(const Reading&) = delete;
  Reading& operator=(const Reading&) = delete;

 private:
  bool outermost_;
};

template <auto RealCalls::*kCall, class Function>
struct Hooked;

template <auto RealCalls::*kCall, class Result, class... Arguments>
struct Hooked<kCall, Result (*)(Arguments...)> {
  static Result Do(Arguments... arguments) {
    const Reading reading;
    return (Real().*kCall)(arguments...);
  }
};

}  // namespace

void* ReadingHook(Call call) {
  switch (call) {
#define TCS_DDS_HOOK(name) \
  case kCall_##name:       \
    return reinterpret_cast<void*>(Hooked<&RealCalls::name, decltype(RealCalls::name)>::Do);
    TCS_DDS_READING_CALLS(TCS_DDS_HOOK)
#undef TCS_DDS_HOOK
    default:
      return nullptr;
  }
}

}  // namespace tcs::dds
