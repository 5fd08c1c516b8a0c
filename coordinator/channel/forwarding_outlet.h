// An outlet that stands before another one, to see what goes out. All but sending is the other's.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <utility>

#include "coordinator/channel/channel.h"

namespace tcs {

class ForwardingOutlet : public Outlet {
 public:
  explicit ForwardingOutlet(std::unique_ptr<Outlet> outlet) : outlet_(std::move(outlet)) {}

  bool Send(const Reading& reading, VirtualTime arrives) override {
    return outlet_->Send(reading, arrives);
  }
  VirtualTime NextDue() const final { return outlet_->NextDue(); }
  bool HandOver(VirtualTime now) final { return outlet_->HandOver(now); }
  std::size_t Kept() const final { return outlet_->Kept(); }
  std::string WhyUnheard() const final { return outlet_->WhyUnheard(); }
  std::string WhatWasLost() const final { return outlet_->WhatWasLost(); }
  void TellOf(DatagramWatch& watch, const std::string& channel) final {
    outlet_->TellOf(watch, channel);
  }

 private:
  const std::unique_ptr<Outlet> outlet_;
};

}  // namespace tcs
