// The sink of recorded messages that are on no topic of DDS: messages of ROS 2's types, as CDR.
//
// Not thread-safe. Nothing here fails: the recording's end says what could not be written.
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

  // The topic's number, for WriteOwn. A topic that is there already with that type is the same
  // topic.
  virtual int AddOwnTopic(std::string_view name, std::string_view type) = 0;
  virtual void WriteOwn(int topic, VirtualTime at, std::span<const std::byte> cdr) = 0;
  // Virtual CLOCK_REALTIME at that time, for stamps in messages.
  virtual std::int64_t StampOf(VirtualTime at) const = 0;
};

}  // namespace tcs::record
