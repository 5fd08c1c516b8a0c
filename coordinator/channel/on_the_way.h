// Messages that have been sent and have not arrived yet, in order.
#pragma once

#include <cstddef>
#include <deque>
#include <string>
#include <utility>

#include "shm/virtual_time.h"

namespace tcs {

class OnTheWay {
 public:
  // `arrives` is not before the last message's.
  void Add(std::string message, VirtualTime arrives) {
    messages_.push_back({arrives, std::move(message)});
  }

  VirtualTime NextDue() const {
    return messages_.empty() ? VirtualTime::Never() : messages_.front().arrives;
  }

  std::size_t size() const { return messages_.size(); }

  // Calls `receive` with each message that has arrived by `now`. True if there was one.
  template <class Receive>
  bool Arrive(VirtualTime now, Receive receive) {
    bool any = false;
    for (; NextDue() <= now; any = true) {
      receive(messages_.front().text);
      messages_.pop_front();
    }
    return any;
  }

 private:
  struct Message {
    VirtualTime arrives;
    std::string text;
  };
  std::deque<Message> messages_;
};

}  // namespace tcs
