// Why an activation took as long as it did, in words. Pure.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "coordinator/explain/told.h"

namespace tcs::explain {

struct Part {
  std::int64_t ns = 0;
  std::string what;  // "drone/planner, of higher priority, had the core"
};

// The parts of the activation's time, which together are the whole.
std::vector<Part> PartsOf(const Activation& activation,
                          const std::map<std::string, Client>& clients);

// "at 3.120 s drone/controller answered 41 ms late: …", or how long the activation took, if it
// was not late.
std::string SentenceOn(const Activation& activation, const std::map<std::string, Client>& clients);

// For an activation that was in the queue for most of its time: the last activation before it that
// was not in the queue at all, and which the queue goes back to. Null: `activation` was not in the
// queue for so long, or the other one is not told of. `activation` is one of `told`.
const Activation* QueuedBehind(const Told& told, const Activation& activation);

// "at 3.120 s drive acted on a sample of lidar that was 61 ms old: …", for the chain of that
// name.
std::string SentenceOn(const std::string& name, const Chain& chain, const ChainCase& one);
// The parts of the sample's age, which together are the whole.
std::vector<Part> PartsOf(const ChainCase& one);

struct Choice {
  std::string client;                 // empty: all
  std::optional<std::int64_t> at_ns;  // activations that were going on then
  std::size_t most = 5;
};

// The activations that were most late, or, where none was late, that took longest; the worst of
// each queue first. Activations at a moment are in the order of their releases.
std::vector<const Activation*> Choose(const Told& told, const Choice& choice);

}  // namespace tcs::explain
