// Tells for which of the files in which programs read of their computer a name stands: its
// processors, its uptime, the use of its processes. Pure: no system calls.
#pragma once

#include <sys/types.h>

#include <optional>
#include <string>
#include <string_view>

namespace tcs {

struct ComputerFile {
  enum class Kind {
    kProcessorTable,   // /proc/cpuinfo
    kCounters,         // /proc/stat
    kUptime,           // /proc/uptime
    kProcessCounters,  // /proc/PID/stat, also of a thread
    kProcessStatus,    // /proc/PID/status
    kProcessSchedule,  // /proc/PID/schedstat
    kProcessorFolder,  // /sys/devices/system/cpu and what is in it
    kNodeFolder,       // /sys/devices/system/node and what is in it
    kQuota,            // cpu.max of a control group
    kOldQuota,         // cpu.cfs_quota_us
    kProcessorSet      // cpuset.cpus and its kin
  };
  Kind kind{};
  // For a process's file: the process and thread that the file is about. Without a thread it is
  // about the whole process.
  pid_t process = 0, thread = 0;
  std::string rest;  // for a folder: the name within it, empty for the folder itself
};

// The absolute name without "." and "..", as if no part of it was a symbolic link.
std::string PlainName(std::string_view path);

// The file of that plain name, as the thread `own_thread` of `own_process` finds it; none: the name
// is of another file.
std::optional<ComputerFile> ComputerFileAt(std::string_view path, pid_t own_process,
                                           pid_t own_thread);

}  // namespace tcs
