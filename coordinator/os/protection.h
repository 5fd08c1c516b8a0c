// The protection of tcsim's own processes from a run's programs, which act as the same user: the
// part of the programs' seccomp filter (trap.h) that refuses to signal, trace, or reschedule these
// processes.
#pragma once

#include <linux/filter.h>
#include <sys/types.h>

#include <vector>

namespace tcs {

// Instructions for right after the number of a call has been loaded, of this architecture or of the
// 32-bit one, which programs of this one can call, too. The instructions refuse with EPERM a call
// that names one of the `guarded` processes (but not the question whether the process is there,
// kill's signal 0). A call may name a process in ways that a filter cannot follow, such as a
// process group or a pidfd. The instructions hand such a call to the coordinator, even where the
// call carries the shim's mark (calls/guarded_calls.cc); they refuse a 32-bit call of this kind,
// for which there is no coordinator. Otherwise the number is loaded again at the end of the
// instructions.
enum class CallTable { kNative, kOf32Bits };
std::vector<sock_filter> Protection(CallTable table, const std::vector<pid_t>& guarded);

}  // namespace tcs
