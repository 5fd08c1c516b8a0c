// How many processors there are, and on which one the caller runs: the robot's cores, never the
// host's.
#include <sched.h>
#include <sys/sysinfo.h>
#include <unistd.h>

#include "libtcs_preload/clock_calls.h"
#include "libtcs_preload/errno_result.h"
#include "libtcs_preload/guest.h"
#include "libtcs_preload/raw_syscall.h"
#include "libtcs_preload/real.h"

using namespace tcs::preload;

TCS_EXPORT int sched_getcpu(void) noexcept {
  const GuestThread* const t = Enter(Concern::kNobody);
  if (t != nullptr) return static_cast<int>(t->slot->core);
  unsigned cpu = 0;
  RawSyscall(SYS_getcpu, Arg(&cpu), 0, 0);
  return static_cast<int>(cpu);
}

long tcs::preload::GetCpu(unsigned* cpu, unsigned* node) {
  const GuestThread* const t = Enter(Concern::kNobody);
  if (t == nullptr) return RawSyscall(SYS_getcpu, Arg(cpu), Arg(node), 0);
  if (cpu != nullptr) *cpu = t->slot->core;
  if (node != nullptr) *node = 0;
  return 0;
}

TCS_EXPORT int getcpu(unsigned* cpu, unsigned* node) noexcept {
  return static_cast<int>(ToErrno(GetCpu(cpu, node)));
}

TCS_EXPORT int get_nprocs(void) noexcept {
  const GuestThread* const t = Enter(Concern::kNobody);
  return t != nullptr ? static_cast<int>(t->slot->cores) : TCS_REAL(get_nprocs)();
}

TCS_EXPORT int get_nprocs_conf(void) noexcept {
  const GuestThread* const t = Enter(Concern::kNobody);
  return t != nullptr ? static_cast<int>(t->slot->cores) : TCS_REAL(get_nprocs_conf)();
}

TCS_EXPORT long sysconf(int name) noexcept {
  if (name == _SC_NPROCESSORS_ONLN || name == _SC_NPROCESSORS_CONF) {
    const GuestThread* const t = Enter(Concern::kNobody);
    if (t != nullptr) return static_cast<long>(t->slot->cores);
  }
  return TCS_REAL(sysconf)(name);
}
