// How well a client kept up, as it is reported: by its releases, its deadlines, and what it was
// sent. Times are virtual nanoseconds.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "coordinator/answers/distribution.h"

namespace tcs {

// Activations that a deadline was for. An activation that had not ended when the run did counts as
// it stood.
struct DeadlineFigures {
  std::int64_t deadline_ns = 0;  // 0: there is none
  std::string source;            // whose period it is, a channel or "its timer"; empty: `deadline:`
  std::int64_t judged = 0, missed = 0, most_in_a_row = 0;
  std::int64_t first_missed_ns = -1;  // the release of the first late activation; -1: none
};

// How activations that missed their deadlines spent their time, in all.
struct LateTime {
  std::int64_t total_ns = 0;                      // from release to end
  std::int64_t queued_ns = 0;                     // the client was still at what had come earlier
  std::int64_t executed_ns = 0;                   // the client's own thread computed
  std::map<std::string, std::int64_t> others_ns;  // ready, while that client had the core
  std::map<std::string, std::int64_t> locks_ns;   // for a lock that the client's thread had
  std::int64_t away_ns = 0;                       // asleep, or waiting for something else
  std::int64_t wakeup_ns = 0;                     // until the kernel had woken it
  std::int64_t room_ns = 0;                       // for others to take what it had sent
};

// The activation in which a thread was ready for longest while others had its cores.
struct LongestWait {
  std::int64_t waited_ns = 0;  // in all of it
  std::int64_t release_ns = 0, response_ns = 0;
  std::string by;  // the client that had them for most of that
};

// The messages to a client over one channel, or from one program.
struct InputFigures {
  std::string from;  // a channel of the scenario, or "CLIENT over WHAT"
  std::int64_t sent = 0, received = 0;
  std::int64_t lost = 0;      // the socket was full
  std::int64_t replaced = 0;  // by later samples, as a reader's history has it
  std::int64_t unread = 0;    // at the run's end
  std::int64_t most_waiting = 0;
  std::int64_t oldest_unread_ns = -1;  // when the oldest one was sent; -1: none
  Distribution age;                    // of received messages, at their receipt
};

// Of activations by time or input.
struct ActivationTimes {
  Distribution response;     // from the release to the end
  Distribution start_delay;  // from the release to the beginning
  Distribution execution;    // computing

  void Add(const ActivationTimes& others);
};

struct ClientFigures {
  // Activations count that ended after that: the time before the first sample, or command, was the
  // client's start.
  std::int64_t after_ns = -1;
  ActivationTimes times;  // of activations with a deadline; of all, if there are none
  DeadlineFigures deadline;
  LateTime late;
  LongestWait longest_wait;  // of any of its threads, whatever the cause
  std::vector<InputFigures> inputs;
  // For each command the age of the sample that its sender had last taken.
  Distribution command_age;
  std::map<int, std::int64_t> core_ns;  // how long the client had each core of its robot
  bool commands = false;                // a message of the client reaches an actuator
};

}  // namespace tcs
