// What the kernel says of a program's rights when it is asked. Who the program is does not tell.
#pragma once

#include <errno.h>
#include <linux/capability.h>
#include <sched.h>
#include <sys/syscall.h>
#include <unistd.h>

namespace conformance {

inline bool HasCapability(int number) {
  __user_cap_header_struct header{_LINUX_CAPABILITY_VERSION_3, 0};
  __user_cap_data_struct sets[_LINUX_CAPABILITY_U32S_3] = {};
  return syscall(SYS_capget, &header, sets) == 0 &&
         (sets[number / 32].effective >> (number % 32) & 1) != 0;
}

// A seccomp filter of the host refuses the system calls that ask for real-time priorities. It does
// so with a program's raw calls, too, before tcs hears of them. Without a parameter such a call is
// invalid otherwise, natively and under tcs.
inline bool AreRealTimeCallsFiltered() {
  return syscall(SYS_sched_setscheduler, 0, SCHED_FIFO, nullptr) == -1 && errno == EPERM;
}

}  // namespace conformance
