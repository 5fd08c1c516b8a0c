#include "coordinator/channel/json/json_channel.h"

#include "coordinator/channel/json/json_codec.h"

namespace tcs {

bool JsonOutlet::Send(const Reading& reading, VirtualTime arrives) {
  on_the_way_.Add(EncodeReading(reading, fields_), arrives);
  return false;
}

bool JsonOutlet::HandOver(VirtualTime now) {
  return on_the_way_.Arrive(now, [this](const std::string& datagram) { sender_->Send(datagram); });
}

void JsonInlet::Receive(const CommandSent& now, CommandSink& sink) {
  while (const auto datagram = receiver_->Receive()) {
    TakeCommand("the command datagram", *datagram, channel_, now, sink);
  }
}

}  // namespace tcs
