// Records the readings and commands on channels that are not on DDS, as ROS 2 messages in the run's
// recording: each reading when it arrives, each command when it was sent. Outlets and inlets are
// wrapped, and do what they did.
//
// The topics of a channel:
//   /channels/NAME         what its sensor of one body, of joints or of its own reads; its commands
//   /channels/NAME/BODY    where it has several bodies
//   .../imu                what such a body feels, where the channel carries that besides
//
// Numbers of a body's state that the channel does not carry are NaN.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "coordinator/channel/channel.h"
#include "coordinator/record/message_sink.h"
#include "coordinator/scenario/scenario.h"

namespace tcs {

class ChannelRecords {
 public:
  // The scenario outlives this, which outlives what it has wrapped.
  explicit ChannelRecords(const Scenario& scenario) : scenario_(scenario) {}
  ChannelRecords(const ChannelRecords&) = delete;
  ChannelRecords& operator=(const ChannelRecords&) = delete;

  // The outlet of the scenario's sensor of that number.
  std::unique_ptr<Outlet> Wrap(std::size_t sensor, std::unique_ptr<Outlet> outlet);
  std::unique_ptr<Inlet> Wrap(std::unique_ptr<Inlet> inlet);

  // Records from now on; the sink outlives this.
  void RecordInto(record::MessageSink& sink) { sink_ = &sink; }

 private:
  class WrappedOutlet;
  class WrappedInlet;
  class Listener;
  // A topic that is made when it is needed.
  struct Topic {
    int number = -1;
  };
  void Write(Topic* topic, const std::string& name, std::string_view type, VirtualTime at,
             std::span<const std::byte> cdr);

  const Scenario& scenario_;
  record::MessageSink* sink_ = nullptr;  // null: nothing is recorded yet
};

}  // namespace tcs
