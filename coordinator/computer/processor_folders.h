// /sys/devices/system/cpu and /sys/devices/system/node of a computer with so many cores: one
// processor whose cores are like those of the host, each with its own caches but for the last
// level, and one node with all memory. They are folders on disk or in /dev/shm, since only those
// can be listed; made when they are first looked at, and gone with this object, however the process
// ends.
//
// For the coordinator's thread only.
#pragma once

#include <cstddef>
#include <string>

#include "coordinator/port/unique_fd.h"

namespace tcs {

class ProcessorFolders {
 public:
  enum class Which { kProcessors, kNodes };

  explicit ProcessorFolders(std::size_t cores) : cores_(cores) {}
  ~ProcessorFolders();
  ProcessorFolders(const ProcessorFolders&) = delete;
  ProcessorFolders& operator=(const ProcessorFolders&) = delete;

  // What has that name in there, for reading, by open's flags. Empty: the folder itself. None:
  // errno is set, to ENOSYS where the folders cannot be made.
  UniqueFd Open(Which which, const std::string& name, int flags);

 private:
  bool Make();
  void MakeCore(std::size_t core) const;
  void MakeProcessors() const;
  void MakeNodes() const;

  const std::size_t cores_;
  std::string path_;  // empty: not made yet, or it cannot be made
  bool tried_ = false;
};

}  // namespace tcs
