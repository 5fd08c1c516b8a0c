// How well a client kept up, as it is reported: by its releases, its deadlines, and what it was
// sent. All times are virtual nanoseconds.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "coordinator/answers/distribution.h"

namespace tcs {

// Activations that a deadline was for. One that had not ended when the run did counts as it stood.
struct DeadlineFigures {
  std::int64_t deadline_ns = 0;  // 0: there is none
  std::string source;            // whose period it is, a channel or "its timer"; empty: `deadline:`
  std::int64_t judged = 0, missed = 0, most_in_a_row = 0;
  std::int64_t first_missed_ns = -1;  // the release of the first that was late; -1: none
};

// What the time of activations that missed their deadlines was spent on, in all.
struct LateTime {
  std::int64_t total_ns = 0;                      // from release to end
  std::int64_t queued_ns = 0;                     // the client was still at what had come earlier
  std::int64_t executed_ns = 0;                   // its own thread computed
  std::map<std::string, std::int64_t> others_ns;  // it was ready, and that client had the core
  std::map<std::string, std::int64_t> locks_ns;   // for a lock that the client's thread had
  std::int64_t away_ns = 0;                       // it slept, or waited for something else
  std::int64_t room_ns = 0;                       // for others to take what it had sent
};

// The activation in which it was ready for longest while others had its cores.
struct LongestWait {
  std::int64_t waited_ns = 0;  // in all of it
  std::int64_t release_ns = 0, response_ns = 0;
  std::string by;  // the client that had them for most of that
};

// What was sent to it over one channel, or by one program.
struct InputFigures {
  std::string from;  // a channel of the scenario, or "CLIENT over WHAT"
  std::int64_t sent = 0, received = 0;
  std::int64_t lost = 0;      // the socket was full
  std::int64_t replaced = 0;  // by later samples, as a reader's history has it
  std::int64_t unread = 0;    // at the run's end
  std::int64_t most_waiting = 0;
  std::int64_t oldest_unread_ns = -1;  // when that was sent; -1: none
  Distribution age;                    // of what it received, when it did
};

// Of activations by time or input.
struct ActivationTimes {
  Distribution response;     // from the release to the end
  Distribution start_delay;  // from the release to the beginning
  Distribution execution;    // computing

  void Add(const ActivationTimes& others);
};

struct ClientFigures {
  // Activations count that ended after that: what came before the first sample, or command, was its
  // start.
  std::int64_t after_ns = -1;
  ActivationTimes times;  // of those that a deadline was for; of all, if there is none
  DeadlineFigures deadline;
  LateTime late;
  LongestWait longest_wait;  // of any of its threads, whatever the cause
  std::vector<InputFigures> inputs;
  // How old the sample was that its sender had last taken, of each command.
  Distribution command_age;
  std::map<int, std::int64_t> core_ns;  // for how long it had each core of its robot
  bool commands = false;                // something that it sends reaches an actuator
};

}  // namespace tcs
