// without_real_time COMMAND...: executes it behind a seccomp filter that refuses real-time
// priorities, as systemd's RestrictRealtime does, and pidfd_getfd. Whoever calls keeps all
// capabilities.
#include <errno.h>
#include <linux/audit.h>
#include <linux/sched.h>
#include <sched.h>
#include <stddef.h>

#include "tests/programs/seccomp_filter.h"

using namespace seccomp_filter;

namespace {

std::vector<sock_filter> Filter() {
  const sock_filter allow = Return(SECCOMP_RET_ALLOW);
  const sock_filter refuse = Return(SECCOMP_RET_ERRNO | EPERM);
  std::vector<sock_filter> code{
      Load(offsetof(seccomp_data, arch)), Jump(BPF_JEQ, AUDIT_ARCH_X86_64, 1, 0), allow,
      Load(offsetof(seccomp_data, nr)), Jump(BPF_JEQ, SYS_pidfd_getfd, 0, 1), refuse,
      // The policy is where a filter does not see it.
      Jump(BPF_JEQ, SYS_sched_setattr, 0, 1), refuse, Jump(BPF_JEQ, SYS_sched_setscheduler, 1, 0),
      allow, Load(offsetof(seccomp_data, args) + sizeof(__u64)),
      Statement(BPF_ALU | BPF_AND | BPF_K, ~SCHED_RESET_ON_FORK)};
  for (const unsigned policy : {SCHED_FIFO, SCHED_RR, SCHED_DEADLINE}) {
    code.push_back(Jump(BPF_JEQ, policy, 0, 1));
    code.push_back(refuse);
  }
  code.push_back(allow);
  return code;
}

bool RefusesRealTimeAlone() {
  const sched_param one{1}, none{0};
  return sched_setscheduler(0, SCHED_FIFO, &one) != 0 && errno == EPERM &&
         sched_setscheduler(0, SCHED_OTHER, &none) == 0;
}

}  // namespace

int main(int, char** argv) { return ExecuteBehind(Filter(), RefusesRealTimeAlone, argv); }
