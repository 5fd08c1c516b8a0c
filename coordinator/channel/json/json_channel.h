// Sensors and commands as JSON (json_codec.h), a datagram each, whatever carries datagrams.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "coordinator/channel/channel.h"
#include "coordinator/channel/datagram_watch.h"
#include "coordinator/channel/on_the_way.h"
#include "coordinator/scenario/scenario.h"

namespace tcs {

class DatagramSender {
 public:
  virtual ~DatagramSender() = default;
  // Does not wait. False: the datagram is lost, because the receiver has no room, as on a network.
  virtual bool Send(const std::string& datagram) = 0;
  virtual shm::ReceiverAddress To() const = 0;
  // False: the datagrams sent so far are lost, because no program had the address. Asked only where
  // that matters.
  virtual bool IsHeard() { return true; }
  virtual std::string WhyUnheard() const = 0;  // as Outlet's
};

class DatagramReceiver {
 public:
  virtual ~DatagramReceiver() = default;
  virtual int fd() const = 0;
  // All datagrams that have come, whole, in order.
  virtual std::vector<std::string> ReceiveAll() = 0;
  // "on 127.0.0.1:47011"
  virtual std::string Where() const = 0;
};

class JsonOutlet final : public Outlet {
 public:
  JsonOutlet(std::unique_ptr<DatagramSender> sender, std::vector<SensorField> fields)
      : sender_(std::move(sender)), fields_(std::move(fields)) {}

  bool Send(const Reading& reading, VirtualTime arrives) override;
  VirtualTime NextDue() const override { return on_the_way_.NextDue(); }
  bool HandOver(VirtualTime now) override;
  std::size_t Kept() const override { return on_the_way_.size(); }
  std::string WhyUnheard() const override { return sender_->WhyUnheard(); }
  void TellOf(DatagramWatch& watch, const std::string& channel) override {
    watch_ = &watch;
    channel_ = channel;
  }

 private:
  std::unique_ptr<DatagramSender> sender_;
  const std::vector<SensorField> fields_;
  OnTheWay on_the_way_;
  DatagramWatch* watch_ = nullptr;
  std::string channel_;  // for watch_
};

class JsonInlet final : public Inlet {
 public:
  // `channel` is the channel's number among the scenario's command channels.
  JsonInlet(std::unique_ptr<DatagramReceiver> receiver, std::size_t channel)
      : receiver_(std::move(receiver)), channel_(channel) {}

  int fd() const override { return receiver_->fd(); }
  void Receive(const CommandSent& now, CommandSink& sink) override;
  void Accept(std::string_view datagram, const CommandSent& sent, CommandSink& sink) override;
  void TellOf(DatagramWatch& watch) override { watch_ = &watch; }
  Place PlaceOf(std::size_t) const override {
    return {receiver_->Where(), "send its commands there"};
  }

 private:
  std::unique_ptr<DatagramReceiver> receiver_;
  std::size_t channel_;
  DatagramWatch* watch_ = nullptr;
};

}  // namespace tcs
