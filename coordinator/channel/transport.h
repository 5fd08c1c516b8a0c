// The things that channels of one transport have in common, and what channels need of a run to be
// opened.
#pragma once

#include <functional>
#include <string>

#include "shm/virtual_time.h"

namespace tcs {

// The things that the channels of one kind have in common, if any.
class Transport {
 public:
  virtual ~Transport() = default;
  // The run begins; virtual CLOCK_REALTIME is so far ahead of virtual time.
  virtual void Begin(VirtualDuration realtime_offset) = 0;
};

// A file that a robot's programs find under another name.
struct FileAlias {
  std::string robot;
  std::string name;  // the name that programs open
  std::string file;  // the file that is opened instead
};

// Has a socket made where programs reach that IPv4 address.
using MakeAt = std::function<void(const std::string& address, const std::function<void()>& make)>;

}  // namespace tcs
