// What keeps a run's programs, who act as the same user, from tcsim's own processes: the part of
// their seccomp filter (trap.h) that refuses to signal, trace, or reschedule them.
#pragma once

#include <linux/filter.h>
#include <sys/types.h>

#include <vector>

namespace tcs {

// Instructions for right after the number of a call has been loaded, of this architecture or of
// the 32-bit one, which programs of this one can call, too. They refuse with EPERM what names one
// of the `guarded` (but not the question whether it is there, kill's signal 0). What names it in
// ways that a filter cannot follow, such as a process group or a pidfd, they hand to the
// coordinator, even where it carries the shim's mark (calls/guarded_calls.cc); or refuse it where
// there is no coordinator for it, in 32-bit calls. Otherwise the number is loaded again at their
// end.
enum class CallTable { kNative, kOf32Bits };
std::vector<sock_filter> Protection(CallTable table, const std::vector<pid_t>& guarded);

}  // namespace tcs
