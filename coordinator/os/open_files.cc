#include "coordinator/os/open_files.h"

#include <linux/kcmp.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <string>

namespace tcs {

bool IsSameFile(int one, int other) {
  const pid_t own = getpid();
  return syscall(SYS_kcmp, own, own, KCMP_FILE, one, other) == 0;
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
  const pid_t own = getpid();
  const kcmp_epoll_slot slot{static_cast<std::uint32_t>(epoll_fd),
                             static_cast<std::uint32_t>(entry.fd), 0};
  return syscall(SYS_kcmp, own, own, KCMP_EPOLL_TFD, fd, &slot) == 0;
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
