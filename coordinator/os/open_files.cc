#include "coordinator/os/open_files.h"

#include <errno.h>
#include <fcntl.h>
#include <linux/kcmp.h>
#include <sys/epoll.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <string>

#include "coordinator/port/unique_fd.h"

namespace tcs {

namespace {

// Compares two files of this process by kcmp: 0 if they are the same; -1: errno is set.
long CompareOwn(int type, int one, std::uint64_t other) {
  const pid_t own = getpid();
  return syscall(SYS_kcmp, own, own, type, one, other);
}

// kcmp is refused, as by the seccomp profile that Docker has for all containers.
bool IsRefused(long compared) { return compared < 0 && (errno == EPERM || errno == ENOSYS); }

// An entry of an epoll set is known there by its open file and its number: a second entry that is
// the same in both is refused.
bool IsInSet(int epoll_fd, int fd) {
  epoll_event none{};
  if (epoll_ctl(epoll_fd, EPOLL_CTL_ADD, fd, &none) != 0) return errno == EEXIST;
  epoll_ctl(epoll_fd, EPOLL_CTL_DEL, fd, nullptr);
  return false;
}

}  // namespace

bool IsSameFileBySet(int one, int other) {
  const UniqueFd set(epoll_create1(EPOLL_CLOEXEC)), number(fcntl(one, F_DUPFD_CLOEXEC, 0));
  epoll_event none{};
  if (epoll_ctl(set.get(), EPOLL_CTL_ADD, number.get(), &none) != 0) return false;
  // The entry stays: its file is still open.
  return dup3(other, number.get(), O_CLOEXEC) >= 0 && IsInSet(set.get(), number.get());
}

// Works in a child, whose descriptors can have any number.
bool IsAboutBySet(int epoll_fd, const EpollEntry& entry, int fd) {
  const pid_t child = fork();
  if (child == 0) {
    const int set = fcntl(epoll_fd, F_DUPFD_CLOEXEC, entry.fd + 1);
    const bool is_placed = set >= 0 && (fd == entry.fd || dup2(fd, entry.fd) >= 0);
    _exit(is_placed && IsInSet(set, entry.fd) ? 0 : 1);
  }
  int status = 1;
  return child > 0 && waitpid(child, &status, 0) == child && status == 0;
}

bool IsSameFile(int one, int other) {
  const long compared = CompareOwn(KCMP_FILE, one, static_cast<std::uint64_t>(other));
  return compared == 0 || (IsRefused(compared) && IsSameFileBySet(one, other));
}

std::optional<bool> Means(pid_t tid, int number, int own) {
  const long compared = syscall(SYS_kcmp, getpid(), tid, KCMP_FILE, own, number);
  if (compared >= 0) return compared == 0;
  if (errno == EBADF) return false;
  return std::nullopt;
}

std::vector<EpollEntry> EntriesOf(int epoll_fd) {
  std::vector<EpollEntry> entries;
  std::ifstream file("/proc/self/fdinfo/" + std::to_string(epoll_fd));
  for (std::string line; std::getline(file, line);) {
    EpollEntry entry;
    if (sscanf(line.c_str(), "tfd: %d events: %x", &entry.fd, &entry.events) == 2) {
      entries.push_back(entry);
    }
  }
  return entries;
}

bool IsAbout(int epoll_fd, const EpollEntry& entry, int fd) {
  const kcmp_epoll_slot slot{static_cast<std::uint32_t>(epoll_fd),
                             static_cast<std::uint32_t>(entry.fd), 0};
  const long compared = CompareOwn(KCMP_EPOLL_TFD, fd, reinterpret_cast<std::uint64_t>(&slot));
  return compared == 0 || (IsRefused(compared) && IsAboutBySet(epoll_fd, entry, fd));
}

bool IsAnonymous(pid_t pid, int fd, std::string_view kind) {
  const std::string link = "/proc/" + std::to_string(pid) + "/fd/" + std::to_string(fd);
  char target[64];
  const ssize_t size = readlink(link.c_str(), target, sizeof target);
  return size > 0 && std::string_view(target, static_cast<std::size_t>(size)) == kind;
}

bool IsTerminal(int fd) {
  struct stat status {};
  return fstat(fd, &status) == 0 && S_ISCHR(status.st_mode) && isatty(fd) != 0;
}

std::size_t RoomForDescriptors(pid_t pid) {
  std::ifstream file("/proc/" + std::to_string(pid) + "/status");
  std::size_t room = 0;
  for (std::string line; std::getline(file, line);) {
    if (sscanf(line.c_str(), "FDSize: %zu", &room) == 1) break;
  }
  return room;
}

}  // namespace tcs
