// Which open files are the same one, and what is in an epoll set: of this process's descriptors,
// which may be copies of clients'. And facts on the clients' own descriptors.
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace tcs {

// Whether both are descriptors of one open file, however they were copied. Where the kernel refuses
// to compare them (kcmp), the first way takes the second one, which knows only files that can be
// polled.
bool IsSameFile(int one, int other);
bool IsSameFileBySet(int one, int other);

// Whether the other thread's descriptor of that number is the open file `own`, of this process's.
// None: the kernel refuses to say.
std::optional<bool> Means(pid_t tid, int number, int own);

struct EpollEntry {
  int fd = -1;               // the number when it was added, in the process that added it
  std::uint32_t events = 0;  // EPOLL* bits
};
// Empty for a descriptor of no epoll set.
std::vector<EpollEntry> EntriesOf(int epoll_fd);

// Whether `fd` is the open file that the set's entry is about. The second way forks.
bool IsAbout(int epoll_fd, const EpollEntry& entry, int fd);
bool IsAboutBySet(int epoll_fd, const EpollEntry& entry, int fd);

// Whether the process's descriptor is a file without a name of that kind, for example kEpollSet. No
// file with a name can be taken for one: names begin with a slash.
inline constexpr std::string_view kEpollSet = "anon_inode:[eventpoll]",
                                  kEventFd = "anon_inode:[eventfd]",
                                  kTimerFd = "anon_inode:[timerfd]";
bool IsAnonymous(pid_t pid, int fd, std::string_view kind);

// False for a number that is no open descriptor.
bool IsTerminal(int fd);

// How large the process's table of descriptors is.
std::size_t RoomForDescriptors(pid_t pid);

}  // namespace tcs
