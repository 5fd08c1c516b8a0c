// A link is one direction between two robots: how long a packet takes, and whether it arrives.
//
// The model is a line with a queue before it. A packet waits until the packets before it have been
// sent. Then it takes the time of its bits at the link's bandwidth, the latency, and a share of the
// jitter, drawn evenly for each packet. Packets arrive in the order in which they were sent. A
// packet that finds the queue full is dropped; a packet that is lost was sent, and took its time.
// Random numbers come from the scenario's seed, so the same packets at the same times have the same
// fate.
//
// Pure: no system calls, no clock. Not thread-safe.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "coordinator/scenario/network_spec.h"
#include "shm/random_stream.h"
#include "shm/virtual_time.h"

namespace tcs {

class NetworkLink {
 public:
  struct Counts {
    std::uint64_t packets = 0, bytes = 0;  // that the link was to send
    std::uint64_t lost = 0, dropped = 0;   // of these packets
  };

  // `number` tells the links of a network apart.
  NetworkLink(const LinkSpec& spec, std::uint64_t seed, std::uint64_t number)
      : spec_(spec), random_(seed, RandomPurpose::kFate, number) {}

  // When a packet of so many bytes, sent at that time, arrives; nothing: the packet does not
  // arrive. A packet that is sent for an earlier time than the packet before goes after that one.
  std::optional<VirtualTime> Send(VirtualTime at, std::size_t bytes);

  // The same, for a message that may be larger than a packet, and then goes in several.
  struct Passage {
    VirtualTime arrives;
    bool is_whole = true;  // no packet of the message was lost or dropped
  };
  Passage SendMessage(VirtualTime at, std::size_t bytes);

  // Whether a message gets through that is sent once more: then nothing is in its way but loss.
  bool GetsThroughAgain(std::size_t bytes);

  const LinkSpec& spec() const { return spec_; }
  const Counts& counts() const { return counts_; }

 private:
  // When the packet's last bit has been sent; nothing: the packet is dropped.
  std::optional<VirtualTime> Transmit(VirtualTime at, std::size_t bytes);

  LinkSpec spec_;
  RandomStream random_;
  VirtualTime busy_until_, last_arrival_;
  Counts counts_;
};

}  // namespace tcs
