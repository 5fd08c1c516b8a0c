// The results that tell of the activations of a run's clients: responses.csv and summary.json
// (docs/RESULTS.md). Times are virtual nanoseconds.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "coordinator/errors/load_error.h"

namespace tcs::explain {

// The share that a client, or its thread, had of an activation's time.
struct Share {
  std::string client;  // empty: the client is not known
  std::int64_t ns = 0;
};

// An activation, and the parts of the time from its release to its end.
struct Activation {
  std::string client;
  std::int64_t thread = 0;  // 0: the client's first
  std::int64_t release_ns = 0, start_ns = 0, end_ns = 0;
  std::int64_t deadline_ns = 0;  // from the release; 0: there is none
  std::int64_t queued_ns = 0, away_ns = 0, wakeup_ns = 0, executed_ns = 0, room_ns = 0, rest_ns = 0;
  std::vector<Share> cores, locks;  // the client with the most first

  std::int64_t TookNs() const { return end_ns - release_ns; }
  std::int64_t LateNs() const { return deadline_ns > 0 ? TookNs() - deadline_ns : 0; }
};

struct Client {
  std::optional<std::int64_t> priority;  // none: deadlines order threads, or it is not told
  bool has_deadline = false;
  // Activations that ended until then were the client's start.
  std::int64_t counted_after_ns = -1;
};

// A part of a sample's way. Parts are in the order of the way.
struct Hop {
  std::string of;    // as summary.json says it: sensor, waiting, program, held, way or actuator
  std::string name;  // of the channel or the client
  std::int64_t ns = 0;
};

// A command that acted on an old sample.
struct ChainCase {
  std::int64_t sampled_ns = 0, acts_ns = 0;
  std::vector<Hop> hops;
};

struct Chain {
  std::int64_t deadline_ns = 0;  // 0: there is none
  std::int64_t commands = 0, missed = 0;
  std::vector<ChainCase> worst;  // the oldest first
};

struct Told {
  std::map<std::string, Chain> chains;
  std::map<std::string, Client> clients;
  std::vector<Activation> activations;  // in the order of their ends, but for starts
};

// The sentence names what cannot be read, and how to have it.
[[nodiscard]] LoadResult<Told> ReadTold(const std::string& folder);

}  // namespace tcs::explain
