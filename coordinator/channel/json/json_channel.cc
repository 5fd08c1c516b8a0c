#include "coordinator/channel/json/json_channel.h"

#include <string>

#include "coordinator/channel/json/json_codec.h"

namespace tcs {

bool JsonOutlet::Send(const Reading& reading, VirtualTime arrives) {
  on_the_way_.Add(EncodeReading(reading, fields_), arrives);
  return false;
}

bool JsonOutlet::HandOver(VirtualTime now) {
  return on_the_way_.Arrive(now, [this, now](const std::string& datagram) {
    const bool is_there = sender_->Send(datagram);
    if (is_there && watch_ != nullptr && sender_->IsHeard())
      watch_->WorldSent(channel_, sender_->To(), now);
  });
}

void JsonInlet::Receive(const CommandSent& now, CommandSink& sink) {
  for (const std::string& datagram : receiver_->ReceiveAll()) Accept(datagram, now, sink);
}

void JsonInlet::Accept(std::string_view datagram, const CommandSent& sent, CommandSink& sink) {
  if (watch_ != nullptr) watch_->WorldReceived(channel_, sent);
  TakeCommand("the command datagram", datagram, channel_, sent, sink);
}

}  // namespace tcs
