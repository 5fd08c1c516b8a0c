// in_old_kernel COMMAND...: executes it where system calls are unknown that Linux 5.15 does not
// know, and where seccomp(2) does not know the flag by which traps hold signals (5.19).
#include <errno.h>
#include <linux/audit.h>
#include <stddef.h>

#include "tests/programs/seccomp_filter.h"

using namespace seccomp_filter;

namespace {

constexpr unsigned kFirstUnknown = 449;     // futex_waitv, of Linux 5.16
constexpr unsigned kHoldsSignals = 1 << 5;  // SECCOMP_FILTER_FLAG_WAIT_KILLABLE_RECV

std::vector<sock_filter> Filter() {
  const sock_filter allow = Return(SECCOMP_RET_ALLOW);
  return {Load(offsetof(seccomp_data, arch)),
          Jump(BPF_JEQ, AUDIT_ARCH_X86_64, 1, 0),
          allow,
          Load(offsetof(seccomp_data, nr)),
          Jump(BPF_JGE, kFirstUnknown, 0, 1),
          Return(SECCOMP_RET_ERRNO | ENOSYS),
          Jump(BPF_JEQ, SYS_seccomp, 1, 0),
          allow,
          Load(offsetof(seccomp_data, args) + sizeof(__u64)),
          Jump(BPF_JSET, kHoldsSignals, 0, 1),
          Return(SECCOMP_RET_ERRNO | EINVAL),
          allow};
}

// Flags come before the filter, which is nowhere.
bool KnowsLess() {
  return syscall(SYS_seccomp, SECCOMP_SET_MODE_FILTER,
                 SECCOMP_FILTER_FLAG_NEW_LISTENER | kHoldsSignals, nullptr) != 0 &&
         errno == EINVAL;
}

}  // namespace

int main(int, char** argv) { return ExecuteBehind(Filter(), KnowsLess, argv); }
