// The knowledge of a thread, or of a message on its way: the newest sample of each sensor, and the
// way on which it came. The values are shared and never change. Times are virtual nanoseconds.
#pragma once

#include <compare>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

namespace tcs {

// A program on the way of a sample.
struct LineageStep {
  int client = 0;
  std::int64_t arrived_ns = 0;  // in its socket or reader
  std::int64_t took_ns = 0;     // by the thread that sent it on,
  std::int64_t first_ns = 0;    // first then,
  std::int64_t sent_ns = 0;     // and again in this message, as it knew of nothing newer
  std::shared_ptr<const LineageStep> before;  // null: the sensor
};

struct KnownSample {
  std::int64_t sampled_ns = 0;
  std::shared_ptr<const LineageStep> last;  // null: no program has sent the sample on yet
  int steps = 0;                            // the number of steps
};

// Of which chain: of a sensor's samples by whatever way, or of those that have come through so many
// of the clients that a chain names.
struct LineageOf {
  int sensor = 0;
  int chain = -1;  // -1: by whatever way
  int stage = 0;
  auto operator<=>(const LineageOf&) const = default;
};

// In order, without duplicates: many lists are made, and few entries looked up.
using Knowledge = std::vector<std::pair<LineageOf, KnownSample>>;
// The knowledge of a message; null: the message knows of no sample.
using Lineage = std::shared_ptr<const Knowledge>;

}  // namespace tcs
