#include "libtcs_preload/computer_files.h"

#include <errno.h>
#include <fcntl.h>
#include <linux/magic.h>
#include <string.h>
#include <sys/vfs.h>

#include <atomic>

#include "libtcs_preload/descriptor_path.h"
#include "libtcs_preload/guest.h"
#include "libtcs_preload/raw_syscall.h"
#include "libtcs_preload/user_memory.h"
#include "shm/computer_files.h"

namespace tcs::preload {

namespace {

// Whether this process has opened any such file by itself: only then it may read one anew.
std::atomic<bool> g_has_opened{false};

bool BeginsWith(const char* path, const char* with) {
  return strncmp(path, with, strlen(with)) == 0;
}

bool IsReadable(const char* path) {
  const char* const list[] = {path, nullptr};
  return path != nullptr && CanReadStrings(list);
}

// Whether the last part of the name is one that such files have. Most names that begin in some
// folder are told from them by that, at no cost.
bool IsOneOfTheirs(const char* path) {
  const char* last = strrchr(path, '/');
  last = last == nullptr ? path : last + 1;
  static constexpr const char* kNames[] = {"stat",   "status",  "schedstat",
                                           "uptime", "cpuinfo", "node"};
  for (const char* name : kNames) {
    if (strcmp(last, name) == 0) return true;
  }
  return strstr(path, "cpu") != nullptr || strstr(path, "node/") != nullptr;
}

bool IsOnKernelsFiles(int folder) {
  struct statfs status;
  const long result = folder == AT_FDCWD ? RawSyscall(SYS_statfs, Arg("."), Arg(&status))
                                         : RawSyscall(SYS_fstatfs, folder, Arg(&status));
  if (result != 0) return false;
  switch (status.f_type) {
    case PROC_SUPER_MAGIC:
    case SYSFS_MAGIC:
    case CGROUP_SUPER_MAGIC:
    case CGROUP2_SUPER_MAGIC:
      return true;
    default:
      return false;
  }
}

}  // namespace

bool MayBeOfComputer(int folder, const char* path, int flags) {
  if ((flags & (O_ACCMODE | O_CREAT | O_PATH)) != 0 || Current() == nullptr || IsShutDown()) {
    return false;
  }
  if (!IsReadable(path)) return false;
  if (path[0] == '/') {
    while (path[1] == '/') ++path;
    return BeginsWith(path, "/proc/") || BeginsWith(path, "/sys/");
  }
  if (BeginsWith(path, "proc/") || BeginsWith(path, "sys/")) return true;
  return IsOneOfTheirs(path) && IsOnKernelsFiles(folder);
}

// Without the mark by which the trap knows the shim's own calls.
long OpenOfComputer(int folder, const char* path, int flags) {
  const long fd = RawSyscall(SYS_openat, folder, Arg(path), flags, 0, 0, 0);
  if (fd >= 0) g_has_opened.store(true, std::memory_order_relaxed);
  return fd;
}

long OpenProcessorFolder(const char* path, int flags) {
  if (Current() == nullptr || IsShutDown() || path == nullptr) return -EINVAL;
  if (!BeginsWith(path, "/sys/devices/system/cpu/") &&
      !BeginsWith(path, "/sys/devices/system/node/")) {
    return -EINVAL;
  }
  return OpenOfComputer(AT_FDCWD, path, flags | O_RDONLY | O_CLOEXEC);
}

void ReadAnew(int fd) {
  if (!g_has_opened.load(std::memory_order_relaxed)) return;
  char target[128];
  const DescriptorPath link("/proc/self/fd/", fd);
  const long size = RawSyscall(SYS_readlink, Arg(link.text), Arg(target), sizeof target - 1);
  if (size <= 0 || size == static_cast<long>(sizeof target - 1)) return;
  target[size] = '\0';
  constexpr const char* kMemory = "/memfd:";
  if (!BeginsWith(target, kMemory)) return;
  const char* name = target + strlen(kMemory);
  if (!BeginsWith(name, shm::kComputerFile)) return;
  const char* path = name + strlen(shm::kComputerFile);
  char* end = strchr(target, ' ');  // " (deleted)"
  if (end != nullptr) *end = '\0';
  const long fresh = OpenOfComputer(AT_FDCWD, path, O_RDONLY | O_CLOEXEC);
  if (fresh < 0) return;
  const long kept = RawSyscall(SYS_fcntl, fd, F_GETFD);
  RawSyscall(SYS_dup3, fresh, fd, (kept & FD_CLOEXEC) != 0 ? O_CLOEXEC : 0);
  RawSyscall(SYS_close, fresh);
}

}  // namespace tcs::preload

using namespace tcs::preload;

namespace {

off64_t SeekIn(int fd, off64_t offset, int from) {
  const long result = RawSyscall(SYS_lseek, fd, offset, from);
  if (result < 0) {
    errno = static_cast<int>(-result);
    return -1;
  }
  if (result == 0 && from == SEEK_SET) ReadAnew(fd);
  return result;
}

}  // namespace

TCS_EXPORT off_t lseek(int fd, off_t offset, int from) noexcept { return SeekIn(fd, offset, from); }
TCS_EXPORT off64_t lseek64(int fd, off64_t offset, int from) noexcept {
  return SeekIn(fd, offset, from);
}
