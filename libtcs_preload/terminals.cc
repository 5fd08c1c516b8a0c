#include "libtcs_preload/terminals.h"

#include <asm/ioctls.h>
#include <asm/termbits.h>

#include "libtcs_preload/raw_syscall.h"
#include "shm/layout.h"

namespace tcs::preload {

namespace {

constexpr std::int64_t kTenthNs = 100'000'000;  // VTIME's unit

bool SettingsOf(int fd, termios* settings) {
  return RawSyscall(SYS_ioctl, fd, TCGETS, Arg(settings)) == 0;
}

}  // namespace

bool IsTerminal(int fd) {
  termios settings;
  return SettingsOf(fd, &settings);
}

std::int64_t ReadTimeoutOf(int fd) {
  termios settings;
  if (!SettingsOf(fd, &settings)) return shm::kNeverNs;
  if ((settings.c_lflag & ICANON) != 0 || settings.c_cc[VMIN] != 0) return shm::kNeverNs;
  return settings.c_cc[VTIME] * kTenthNs;
}

}  // namespace tcs::preload
