// /sys/devices/system/cpu and /sys/devices/system/node of a computer with so many cores: one
// processor whose cores are like those of the host, each with its own caches but for the last
// level, and one node with all memory. The folders are on disk or in /dev/shm, since only such
// folders can be listed. They are made when they are first looked at, and are gone with this
// object, however the process ends.
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

  // Opens the entry of that name for reading, with open's flags. Empty: the folder itself. None:
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
