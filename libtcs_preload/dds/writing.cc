#include "libtcs_preload/dds/writing.h"

#include <algorithm>
#include <optional>

#include "libtcs_preload/dds/cyclone.h"
#include "libtcs_preload/dds/deliverer.h"
#include "libtcs_preload/dds/muting.h"
#include "libtcs_preload/dds/outgoing.h"
#include "libtcs_preload/dds/program.h"

namespace tcs::dds {
namespace {

// A thread that waits for a reader looks that often whether the reader still is one.
constexpr std::int64_t kLookAgainNs = 10'000'000;

// The process of a reader that is full; 0: none.
std::uint32_t FullReaderOf(const Guid& writer) {
  for (const std::uint32_t process : PromisedProcesses(writer)) {
    if (TheLink().is_full(process)) return process;
  }
  return 0;
}

// Nobody has acknowledged the samples of the writer that a mute domain holds. False: still so at
// the end.
bool AwaitHearing(dds_entity_t writer, const Guid& guid, std::int64_t end_ns) {
  dds_domainid_t domain = 0;
  dds_get_domainid(writer, &domain);
  const auto is_full = [domain, &guid] {
    const Visit visit(domain);
    return visit.gv() != nullptr && IsHeldFull(*visit.gv(), guid);
  };
  while (is_full()) {
    const std::int64_t now = TheLink().now();
    if (now >= end_ns) return false;
    dds_sleepfor(std::min(kLookAgainNs, end_ns - now));
  }
  return true;
}

// As Cyclone does it over a network: a reliable writer that has to keep all that others have not
// taken yet waits before it writes, and gives up after max_blocking_time, having written nothing.
// The deliverer never waits: others may be waiting for what the deliverer takes.
bool HasRoom(dds_entity_t writer) {
  dds_guid_t wire;
  if (IsDeliverer() || dds_get_guid(writer, &wire) != DDS_RETCODE_OK) return true;
  const Guid guid = GuidAt(wire.v);
  const std::optional<std::int64_t> most = MostBlocking(guid);
  if (!most.has_value()) return true;
  const std::int64_t start = TheLink().now();
  const std::int64_t end = *most > INT64_MAX - start ? INT64_MAX : start + *most;
  if (AnyIsMute() && !AwaitHearing(writer, guid, end)) return false;
  while (const std::uint32_t process = FullReaderOf(guid)) {
    const std::int64_t now = TheLink().now();
    if (now >= end) return false;
    if (!TheLink().await_room(process, std::min(end, now + kLookAgainNs))) return true;
  }
  return true;
}

// Releases what a write takes over, whether the write succeeds or not.
void Release(ddsi_serdata* sample) { ddsi_serdata_unref(sample); }
template <class Argument>
void Release(const Argument&) {}

template <auto RealCalls::*kCall, class Function>
struct HookedWrite;

template <auto RealCalls::*kCall, class... Arguments>
struct HookedWrite<kCall, dds_return_t (*)(dds_entity_t, Arguments...)> {
  static dds_return_t Do(dds_entity_t writer, Arguments... arguments) {
    if ((!TheLink().any_is_full() && !AnyIsMute()) || HasRoom(writer)) {
      return (Real().*kCall)(writer, arguments...);
    }
    (Release(arguments), ...);
    return DDS_RETCODE_TIMEOUT;
  }
};

}  // namespace

void* WritingHook(Call call) {
  switch (call) {
#define TCS_DDS_HOOK(name) \
  case kCall_##name:       \
    return reinterpret_cast<void*>(HookedWrite<&RealCalls::name, decltype(RealCalls::name)>::Do);
    TCS_DDS_WRITING_CALLS(TCS_DDS_HOOK)
#undef TCS_DDS_HOOK
    default:
      return nullptr;
  }
}

}  // namespace tcs::dds
