#include "libtcs_preload/timer_fds.h"

#include <sys/stat.h>

#include "libtcs_preload/raw_syscall.h"

namespace tcs::preload {

namespace {

constexpr int kRoom = 512;
TimerFd g_timers[kRoom];
int g_used =
    0;  // entries ever used; most programs have none, and then every look-up is one comparison

// A child by fork does not know its parent's timers by their ids: the coordinator finds them.
TimerFd* Find(int fd) {
  if (fd < 0 || g_used == 0) return nullptr;
  if (!g_process->has_timer_fds) g_used = 0;
  for (int i = 0; i < g_used; ++i) {
    if (g_timers[i].fd == fd) return &g_timers[i];
  }
  return nullptr;
}

}  // namespace

bool RememberTimerFd(int fd, std::int64_t id, Clock clock) {
  // An entry of this number is stale: the entry's descriptor was closed behind our back.
  TimerFd* entry = Find(fd);
  for (int i = 0; entry == nullptr && i < g_used; ++i) {
    if (g_timers[i].fd < 0) entry = &g_timers[i];
  }
  if (entry == nullptr) {
    if (g_used == kRoom) return false;
    entry = &g_timers[g_used++];
  }
  *entry = TimerFd{.fd = fd, .clock = clock, .id = id};
  g_process->has_timer_fds = true;
  return true;
}

TimerFd* FindTimerFd(int fd) { return Find(fd); }

bool IsTimerFd(int fd) {
  TimerFd* timer = Find(fd);
  if (timer == nullptr) return false;
  // A descriptor without a file has no type of file.
  struct stat status;
  if (RawSyscall(SYS_fstat, fd, Arg(&status)) == 0 && (status.st_mode & S_IFMT) == 0) return true;
  timer->fd = -1;
  return false;
}

void NoteShortTimer(std::int64_t id, bool is_short) {
  for (int i = 0; i < g_used; ++i) {
    if (g_timers[i].fd >= 0 && g_timers[i].id == id) g_timers[i].is_short = is_short;
  }
}

void CopyTimerFd(int fd, int copy) {
  if (const TimerFd* timer = Find(fd); timer != nullptr) {
    const TimerFd original = *timer;
    RememberTimerFd(copy, original.id, original.clock);
    if (TimerFd* copied = Find(copy); copied != nullptr) copied->is_short = original.is_short;
  }
}

std::int64_t ForgetTimerFd(int fd) {
  TimerFd* timer = Find(fd);
  if (timer == nullptr) return 0;
  const std::int64_t id = timer->id;
  timer->fd = -1;
  for (int i = 0; i < g_used; ++i) {
    if (g_timers[i].fd >= 0 && g_timers[i].id == id) return 0;
  }
  return id;
}

}  // namespace tcs::preload
