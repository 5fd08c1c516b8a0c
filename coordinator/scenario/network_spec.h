// The network between robots: an address for each, and what is between any two of them. Plain
// values, already checked.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "shm/virtual_time.h"

namespace tcs {

// The link of one direction between two robots.
struct LinkSpec {
  static constexpr double kUnlimited = 0;

  VirtualDuration latency{};              // of each packet, once its last bit has been sent
  VirtualDuration jitter{};               // the most that a packet takes longer than that
  double loss = 0;                        // the share of the packets that do not arrive
  double bandwidth_bps = kUnlimited;      // bits per second
  std::int64_t queue_bytes = 256 * 1024;  // that may wait to be sent; a packet beyond is dropped
};

struct NetworkSpec {
  std::uint64_t seed = 0;
  std::vector<std::string> addresses;  // IPv4, of the scenario's robots in their order
  std::vector<LinkSpec> links;         // of every robot to every robot

  const LinkSpec& Link(std::size_t from, std::size_t to) const {
    return links[from * addresses.size() + to];
  }
};

}  // namespace tcs
