#include "coordinator/os/call_names.h"

#include <sys/syscall.h>

#include <utility>

namespace tcs {

namespace {

constexpr std::pair<int, const char*> kNames[] = {{SYS_close, "close"},
                                                  {SYS_close_range, "close_range"},
                                                  {SYS_dup2, "dup2"},
                                                  {SYS_dup3, "dup3"},
                                                  {SYS_shutdown, "shutdown"},
                                                  {SYS_connect, "connect"},
                                                  {SYS_accept, "accept"},
                                                  {SYS_accept4, "accept4"},
                                                  {SYS_sendto, "sendto"},
                                                  {SYS_sendmsg, "sendmsg"},
                                                  {SYS_recvfrom, "recvfrom"},
                                                  {SYS_recvmsg, "recvmsg"},
                                                  {SYS_read, "read"},
                                                  {SYS_readv, "readv"},
                                                  {SYS_pread64, "pread"},
                                                  {SYS_write, "write"},
                                                  {SYS_writev, "writev"},
                                                  {SYS_pwrite64, "pwrite"},
                                                  {SYS_sendfile, "sendfile"},
                                                  {SYS_splice, "splice"},
                                                  {SYS_tee, "tee"},
                                                  {SYS_vmsplice, "vmsplice"},
                                                  {SYS_copy_file_range, "copy_file_range"},
                                                  {SYS_open, "open"},
                                                  {SYS_openat, "openat"},
                                                  {SYS_getdents64, "getdents64"},
                                                  {SYS_stat, "stat"},
                                                  {SYS_newfstatat, "fstatat"},
                                                  {SYS_statx, "statx"},
                                                  {SYS_rename, "rename"},
                                                  {SYS_unlink, "unlink"},
                                                  {SYS_unlinkat, "unlinkat"},
                                                  {SYS_ftruncate, "ftruncate"},
                                                  {SYS_fallocate, "fallocate"},
                                                  {SYS_fsync, "fsync"},
                                                  {SYS_fdatasync, "fdatasync"},
                                                  {SYS_sync_file_range, "sync_file_range"},
                                                  {SYS_syncfs, "syncfs"},
                                                  {SYS_sync, "sync"},
                                                  {SYS_msync, "msync"},
                                                  {SYS_mmap, "mmap"},
                                                  {SYS_munmap, "munmap"},
                                                  {SYS_madvise, "madvise"},
                                                  {SYS_ioctl, "ioctl"},
                                                  {SYS_mount, "mount"},
                                                  {SYS_umount2, "umount"},
                                                  {SYS_io_getevents, "io_getevents"},
                                                  {SYS_io_uring_enter, "io_uring_enter"},
                                                  {SYS_unshare, "unshare"},
                                                  {SYS_setns, "setns"},
                                                  {SYS_membarrier, "membarrier"}};

}  // namespace

std::string NameOfSystemCall(const std::string& number) {
  for (const auto& [known, name] : kNames) {
    if (number == std::to_string(known)) return std::string(name) + " (system call " + number + ")";
  }
  return "system call " + number;
}

}  // namespace tcs
