#include "libtcs_preload/cycle_counter/tell_of_reads.h"

#include "libtcs_preload/exchange.h"

namespace tcs::preload {

namespace {

bool g_has_told = false;

}  // namespace

bool HasToldOfReads() { return g_has_told; }

void TellOfReads(const LeftReads& left, WhereReads where) {
  GuestThread* thread = IfAttached();
  if (left.count == 0 || g_has_told || thread == nullptr || thread->depth != 0) return;
  g_has_told = true;
  Exchange(*thread, Request{.kind = shm::NotificationKind::kCounterReads,
                            .args = {static_cast<std::int64_t>(left.count),
                                     reinterpret_cast<std::int64_t>(left.first),
                                     static_cast<std::int64_t>(where)}});
}

}  // namespace tcs::preload
