// What the programs of the middlewares share: one sends numbered messages, each with its time, the
// other says when each was there. A middleware is two functions.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

namespace talk {

struct Message {
  std::int64_t number = 0;
  std::int64_t sent_ns = 0;  // CLOCK_REALTIME, which all robots of a run share
};

// Makes the socket and whatever else it takes, then sends what `next` gives, until that is false:
// `next` waits for the time of the message.
using Next = std::function<bool(Message*)>;
void Send(const std::string& where, const Next& next);

// Until `take` is false.
using Take = std::function<bool(const Message&)>;
void Receive(const std::string& where, const Take& take);

// Ends the program.
[[noreturn]] void Fail(const char* what, const char* why);

}  // namespace talk
