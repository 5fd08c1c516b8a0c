// Channels of the type pty: lines of JSON on serial devices, each of them a terminal that the
// coordinator holds and a robot's programs open under the device's name.
//
// A line takes the time of its bits in both directions. A reading's first bit leaves the device
// when the reading arrives there; the program can read each byte once its last bit has come. A
// command has been sent when the last bit of its line's end has gone.
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "coordinator/channel/channel.h"
#include "coordinator/channel/transport.h"
#include "coordinator/scenario/scenario.h"

namespace tcs {

class PtyChannels final : public Transport {
 public:
  PtyChannels();
  ~PtyChannels() override;

  void Begin(VirtualDuration) override {}

  Opened<Outlet> OutletOn(const SerialPort& port, const SensorChannelSpec& spec);
  // For the scenario's channel of commands of that number; at most once for each device.
  Opened<Inlet> InletOn(const SerialPort& port, std::size_t channel);
  // For devices without such a channel: bytes that programs write there are thrown away.
  std::vector<std::unique_ptr<Inlet>> OtherInlets() const;

  std::vector<FileAlias> Aliases() const;

 private:
  class Device;
  class DeviceOutlet;
  class DeviceInlet;
  // The port's device, or one sentence.
  [[nodiscard]] std::variant<Device*, std::string> Find(const SerialPort& port);

  std::map<std::pair<std::string, std::string>, std::unique_ptr<Device>> devices_;
};

}  // namespace tcs
