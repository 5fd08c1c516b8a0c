// The functions that users' programs call by themselves (api/tcs.h), looked up there by these
// names.
#include "libtcs_preload/guest.h"
#include "libtcs_preload/receipts.h"
#include "libtcs_preload/virtual_clock.h"

using namespace tcs::preload;

// False: this process is not in a run.
TCS_EXPORT bool tcs_shim_runs() { return Current() != nullptr; }

TCS_EXPORT void tcs_shim_mark() {
  const Entered t;
  if (t == nullptr) return;
  NoteSent(*t);
  NoteReceived(*t, tcs::shm::Receipts::Of::kTimer);
}

TCS_EXPORT void tcs_shim_read() {
  const Entered t;
  if (t != nullptr) HoldForRead(*t);
}

TCS_EXPORT void tcs_shim_write() {
  const Entered t;
  if (t != nullptr) HoldForWrite(*t);
}
