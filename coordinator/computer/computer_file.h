// Which of the files in which programs read of their computer a name stands for: its processors,
// how long it is on, what its processes have used. Pure: no system calls.
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
    kProcessorFolder,  // what is in /sys/devices/system/cpu
    kNodeFolder,       // what is in /sys/devices/system/node
    kQuota,            // cpu.max of a control group
    kOldQuota,         // cpu.cfs_quota_us
    kProcessorSet      // cpuset.cpus and its kin
  };
  Kind kind{};
  // Of a process's file: whose it is. Without a thread it is the whole process's.
  pid_t process = 0, thread = 0;
  std::string rest;  // of a folder's: the name in there, empty for the folder itself
};

// The absolute name without "." and "..", as if no part of it was a symbolic link.
std::string PlainName(std::string_view path);

// The file of that plain name, as one finds it who is this thread; none: it is another one.
std::optional<ComputerFile> ComputerFileAt(std::string_view path, pid_t own_process,
                                           pid_t own_thread);

}  // namespace tcs
