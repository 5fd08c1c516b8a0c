// How old samples were when a command that could know of them acted, and what that age went into.
// Times are virtual nanoseconds.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "coordinator/answers/distribution.h"

namespace tcs {

// A part of the way from a sensor to an actuator. The parts are in the order of the way.
struct ChainHop {
  enum class Of {
    kSensor,    // from the sample to when the first program has it: the sensor's latency
    kWaiting,   // the sample was there, and the program had not taken it
    kProgram,   // the program's thread had the sample, until it first sent something
    kHeld,      // the thread knew of nothing newer when it sent again
    kWay,       // from one program to the next
    kActuator,  // from the command to when it acts
  };
  Of of = Of::kSensor;
  std::string name;  // of the channel, or of the client
  std::int64_t ns = 0;
};

// A command that knew of a sample.
struct ChainCase {
  std::int64_t sampled_ns = 0, acts_ns = 0;
  std::vector<ChainHop> hops;  // together acts_ns - sampled_ns

  std::int64_t AgeNs() const { return acts_ns - sampled_ns; }
};

// "the latency of lidar", "rover/planner", "the way to rover/wheels".
std::string NameOf(const ChainHop& hop);

struct ChainFigures {
  std::string name;              // "lidar->wheels", or as the scenario calls it
  std::int64_t deadline_ns = 0;  // 0: the chain has none
  bool is_named = false;         // by the scenario
  Distribution age;              // of the newest sample that each command knew of, when it acted
  Distribution reaction;         // from each sample to the first command that could know of it
  std::int64_t missed = 0;       // commands that were older
  std::int64_t first_missed_ns = -1;
  std::vector<ChainCase> worst;   // the oldest first
  std::vector<std::string> path;  // the clients on most commands' way
};

}  // namespace tcs
