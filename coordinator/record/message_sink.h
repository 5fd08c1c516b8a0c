// Where what is recorded goes that is on no topic of DDS: messages of ROS 2's types, as CDR.
//
// Not thread-safe. Nothing here fails: what could not be written is said at the end.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "shm/virtual_time.h"

namespace tcs::record {

class MessageSink {
 public:
  virtual ~MessageSink() = default;

  // For Write. A topic that is there already with that type is the same one.
  virtual int AddOwnTopic(std::string_view name, std::string_view type) = 0;
  virtual void WriteOwn(int topic, VirtualTime at, std::span<const std::byte> cdr) = 0;
  // Virtual CLOCK_REALTIME at that time, for stamps in messages.
  virtual std::int64_t StampOf(VirtualTime at) const = 0;
};

}  // namespace tcs::record
