#include "libtcs_preload/outside.h"

#include <errno.h>
#include <string.h>
#include <sys/stat.h>
#include <x86gprintrin.h>

#include "libtcs_preload/exchange.h"
#include "libtcs_preload/fd_wait.h"
#include "libtcs_preload/raw_syscall.h"
#include "libtcs_preload/user_memory.h"
#include "libtcs_preload/virtual_clock.h"
#include "shm/own_receivers.h"

namespace tcs::preload {

namespace {

using shm::OutsideEvent;

void Tell(GuestThread& thread, OutsideEvent event, int fd, std::uint64_t tsc = 0,
          bool is_so = false) {
  const int error = errno;
  Exchange(thread, Request{.kind = shm::NotificationKind::kOutside,
                           .args = {static_cast<std::int64_t>(event), fd,
                                    static_cast<std::int64_t>(tsc), is_so ? 1 : 0}});
  errno = error;
}

// Whether anything that was asked for is not to be seen yet.
bool IsAnythingHidden(GuestThread& thread) {
  if (!IsAnythingOutside()) return false;
  const shm::OutsideFiles& files = shm::OutsideFilesOf(*g_run);
  const std::uint32_t used = files.used.load(std::memory_order_acquire);
  const std::int64_t now = NowNs(thread);
  for (std::uint32_t i = 0; i < used && i < shm::OutsideFiles::kPlaces; ++i) {
    if (shm::IsOutsideCall(files.places[i].key.load(std::memory_order_relaxed))) continue;
    const std::int64_t from = files.places[i].seen_from_ns.load(std::memory_order_acquire);
    if (from > now && from != shm::kOutsideRests) return true;
  }
  return false;
}

}  // namespace

bool IsAnythingOutside() {
  return g_run != nullptr && shm::OutsideFilesOf(*g_run).used.load(std::memory_order_relaxed) != 0;
}

OutsidePlace* OutsideOf(int fd) {
  if (fd < 0 || !IsAnythingOutside()) return nullptr;
  struct stat status;
  if (RawSyscall(SYS_fstat, fd, Arg(&status)) != 0) return nullptr;
  return shm::OutsidePlaceOf(shm::OutsideFilesOf(*g_run), shm::OutsideKeyOf(status));
}

bool IsHidden(GuestThread& thread, OutsidePlace* place) {
  if (place == nullptr) return false;
  const std::int64_t from = place->seen_from_ns.load(std::memory_order_acquire);
  return from != 0 && from > NowNs(thread);
}

Hides HiddenOf(GuestThread& thread, OutsidePlace* place) {
  if (!IsHidden(thread, place)) return Hides::kNothing;
  const bool is_connecting = place->is_connecting.load(std::memory_order_relaxed) != 0;
  return is_connecting ? Hides::kAll : Hides::kInput;
}

namespace {

bool IsHiddenFromLook(GuestThread& thread, int fd, OutsidePlace* place) {
  if (!IsHidden(thread, place)) return false;
  Tell(thread, OutsideEvent::kLooks, fd);
  return IsHidden(thread, place);
}

}  // namespace

bool IsHiddenFromLook(GuestThread& thread, int fd) {
  return IsHiddenFromLook(thread, fd, OutsideOf(fd));
}

void BeginLookIntoSet(GuestThread& thread, int epoll_fd) {
  if (IsAnythingHidden(thread)) Tell(thread, OutsideEvent::kLooks, epoll_fd);
}

void BeginLooks(GuestThread& thread, const pollfd* fds, unsigned long count) {
  constexpr unsigned long kMost = 1 << 20;
  if (!IsAnythingOutside() || count > kMost || !CanRead(fds, count * sizeof *fds)) return;
  for (unsigned long i = 0; i < count; ++i) {
    OutsidePlace* place = fds[i].events == 0 ? nullptr : OutsideOf(fds[i].fd);
    const bool concerns =
        place != nullptr && ((fds[i].events & POLLIN) != 0 || place->is_connecting.load() != 0);
    if (concerns) IsHiddenFromLook(thread, fds[i].fd, place);
  }
}

long WithoutHidden(GuestThread& thread, pollfd* fds, unsigned long count, long found) {
  if (found <= 0 || !IsAnythingOutside()) return found;
  // Hanging up and errors come from outside, too.
  constexpr auto kFromOutside =
      static_cast<short>(POLLIN | POLLRDNORM | POLLPRI | POLLRDHUP | POLLHUP | POLLERR);
  for (unsigned long i = 0; i < count; ++i) {
    if (fds[i].revents == 0) continue;
    const Hides hides = HiddenOf(thread, OutsideOf(fds[i].fd));
    if (hides == Hides::kNothing) continue;
    const int room = hides == Hides::kAll ? POLLOUT | POLLWRNORM : 0;
    const auto hidden = static_cast<short>(kFromOutside | room);
    if ((fds[i].revents & hidden) == 0) continue;
    fds[i].revents = static_cast<short>(fds[i].revents & ~hidden);
    if (fds[i].revents == 0) --found;
  }
  return found;
}

HiddenMembers::HiddenMembers(GuestThread& thread, int epoll_fd) : epoll_fd_(epoll_fd) {
  if (IsAnythingHidden(thread)) Read(thread);
}

void HiddenMembers::Read(GuestThread& thread) {
  FdInfo info(epoll_fd_);
  EpollMember member;
  while (count_ < kMost && NextMember(info, &member)) {
    if (IsHidden(thread, OutsideOf(member.fd))) members_[count_++] = member;
  }
}

// A member of which the set tells only once is set up anew.
long HiddenMembers::TakeOut(epoll_event* events, long found) const {
  long left = 0;
  for (long i = 0; i < found; ++i) {
    const EpollMember* hidden = nullptr;
    for (int k = 0; k < count_; ++k) {
      if (members_[k].data == events[i].data.u64) hidden = &members_[k];
    }
    if (hidden == nullptr) {
      events[left++] = events[i];
      continue;
    }
    if ((hidden->events & (EPOLLET | EPOLLONESHOT)) != 0) {
      epoll_event again{};
      again.events = hidden->events;
      again.data.u64 = hidden->data;
      RawSyscall(SYS_epoll_ctl, epoll_fd_, EPOLL_CTL_MOD, hidden->fd, Arg(&again));
    }
  }
  return found < 0 ? found : left;
}

bool IsDeviceOutside(const char* path) {
  constexpr char kFolder[] = "/dev/";
  constexpr std::size_t kFolderSize = sizeof kFolder - 1;
  if (Current() == nullptr || strncmp(path, kFolder, kFolderSize) != 0) return false;
  for (const char* device : {"nvidia", "kfd", "dri/", "accel", "video", "apex_", "davinci"}) {
    if (strncmp(path + kFolderSize, device, strlen(device)) == 0) return true;
  }
  return false;
}

void NoteOpens(int fd) {
  if (GuestThread* t = Current(); t != nullptr) Tell(*t, OutsideEvent::kConnects, fd, __rdtsc());
}

void NoteConnects(GuestThread& thread, int fd, std::uint64_t begun_tsc, bool is_going_on) {
  if (g_header->sync != shm::Sync::kConsistent) return;
  Tell(thread, OutsideEvent::kConnects, fd, begun_tsc, is_going_on);
}

OutsideAsk BeginAsk(int fd) { return {__rdtsc(), OutsideOf(fd) != nullptr && PollNow(fd, POLLIN)}; }

void NoteAsks(GuestThread& thread, int fd, const OutsideAsk& ask) {
  if (OutsideOf(fd) == nullptr) return;
  Tell(thread, OutsideEvent::kAsks, fd, ask.begun_tsc, ask.has_input);
}

void NoteTakes(GuestThread& thread, int fd) {
  if (OutsideOf(fd) != nullptr) Tell(thread, OutsideEvent::kTakes, fd);
}

void EndIoctl() {
  GuestThread* t = IsAnythingOutside() ? IfAttached() : nullptr;
  if (t == nullptr) return;
  OutsidePlace* place =
      shm::OutsidePlaceOf(shm::OutsideFilesOf(*g_run), shm::OutsideCallKey(t->slot->tid));
  if (place == nullptr) return;
  const int error = errno;
  if (place->seen_from_ns.load() == shm::kOutsideUnknown) Tell(*t, OutsideEvent::kReturns, -1);
  for (;;) {
    const std::int64_t from = place->seen_from_ns.load();
    if (from >= shm::kOutsideUnknown || from <= NowNs(*t) || IsShutDown()) break;
    SleepUntil(*t, from);
  }
  errno = error;
}

void NoteCloses(int fd) {
  if (OutsideOf(fd) == nullptr) return;
  if (GuestThread* t = Current(); t != nullptr) Tell(*t, OutsideEvent::kCloses, fd);
}

}  // namespace tcs::preload
