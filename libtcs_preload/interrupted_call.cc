#include "libtcs_preload/interrupted_call.h"

#include <errno.h>
#include <linux/futex.h>
#include <sys/syscall.h>

#include <algorithm>
#include <cstdint>
#include <iterator>

#include "shm/layout.h"

namespace tcs::preload {

namespace {

constexpr unsigned char kSyscall[] = {0x0f, 0x05};
constexpr greg_t kSize = sizeof kSyscall;
constexpr greg_t kResumeFlag = 1 << 16;  // an interrupt's own

// These calls are handed over, unless the shim makes them.
constexpr int kNeverRestarted[] = {SYS_nanosleep,  SYS_clock_nanosleep, SYS_poll,
                                   SYS_ppoll,      SYS_select,          SYS_pselect6,
                                   SYS_epoll_wait, SYS_epoll_pwait,     SYS_epoll_pwait2};
constexpr int kRestarted[] = {SYS_futex_waitv, SYS_read,     SYS_readv,    SYS_write,
                              SYS_writev,      SYS_recvfrom, SYS_recvmsg,  SYS_recvmmsg,
                              SYS_sendto,      SYS_sendmsg,  SYS_sendmmsg, SYS_accept,
                              SYS_accept4,     SYS_connect,  SYS_wait4,    SYS_waitid};
// The kernel carries these calls out itself. It may make calls that are in no list (clone) again
// for reasons of its own.
constexpr int kRestartedInKernel[] = {SYS_flock,     SYS_fcntl,           SYS_open,
                                      SYS_openat,    SYS_openat2,         SYS_creat,
                                      SYS_ioctl,     SYS_pread64,         SYS_pwrite64,
                                      SYS_preadv,    SYS_preadv2,         SYS_pwritev,
                                      SYS_pwritev2,  SYS_sendfile,        SYS_splice,
                                      SYS_tee,       SYS_vmsplice,        SYS_mq_timedsend,
                                      SYS_getrandom, SYS_copy_file_range, SYS_mq_timedreceive};

template <std::size_t kCount>
bool IsIn(const int (&list)[kCount], greg_t number) {
  return std::find(std::begin(list), std::end(list), number) != std::end(list);
}

}  // namespace

// The syscall instruction leaves in rcx where it returns to, and the flags in r11. Only at one
// instruction in a tight loop are both there already when a thread is about to execute it.
bool InterruptedCall::IsMadeAgain() const {
  if (registers_[REG_RCX] != registers_[REG_RIP] + kSize) return false;
  if (((registers_[REG_R11] ^ registers_[REG_EFL]) & ~kResumeFlag) != 0) return false;
  const auto* code = reinterpret_cast<const unsigned char*>(registers_[REG_RIP]);
  return code[0] == kSyscall[0] && code[1] == kSyscall[1];
}

EndBySignal InterruptedCall::HowItEnds() const {
  const greg_t number = registers_[REG_RAX];
  if (number == SYS_futex) {
    const int command = static_cast<int>(registers_[REG_RSI]) & FUTEX_CMD_MASK;
    const bool has_timeout = registers_[REG_R10] != 0;
    if (command != FUTEX_WAIT && command != FUTEX_WAIT_BITSET) return EndBySignal::kNone;
    return has_timeout ? EndBySignal::kAlways : EndBySignal::kUnlessRestart;
  }
  if (IsIn(kNeverRestarted, number)) return EndBySignal::kAlways;
  const bool is_restarted = IsIn(kRestarted, number) || IsIn(kRestartedInKernel, number);
  return is_restarted ? EndBySignal::kUnlessRestart : EndBySignal::kNone;
}

bool InterruptedCall::IsHandedOver() const {
  const greg_t number = registers_[REG_RAX];
  if (IsIn(kRestartedInKernel, number)) return false;
  const bool has_mark_in_flags = number == SYS_recvfrom || number == SYS_sendto;
  const auto mark =
      has_mark_in_flags
          ? static_cast<std::uint32_t>(static_cast<std::uint64_t>(registers_[REG_R10]) >> 32)
          : static_cast<std::uint32_t>(registers_[REG_R9]);
  return mark != shm::kOwnCallMark;
}

void InterruptedCall::FailWithEintr() {
  registers_[REG_RIP] += kSize;
  registers_[REG_RAX] = -EINTR;
}

}  // namespace tcs::preload
