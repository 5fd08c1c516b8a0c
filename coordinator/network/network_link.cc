#include "coordinator/network/network_link.h"

#include <algorithm>
#include <cmath>

namespace tcs {

namespace {

// The bytes of a message that go into a packet: an Ethernet packet's, less the heads of IP and UDP.
constexpr std::size_t kMostPayload = 1472, kHeads = 28;

}  // namespace

std::optional<VirtualTime> NetworkLink::Transmit(VirtualTime at, std::size_t bytes) {
  if (spec_.bandwidth_bps == LinkSpec::kUnlimited) return at;
  const double ns_per_byte = 8e9 / spec_.bandwidth_bps;
  const VirtualTime start = std::max(at, busy_until_);
  const double waiting = static_cast<double>((start - at).ns()) / ns_per_byte;
  const bool is_idle = start == at;
  if (!is_idle && waiting + static_cast<double>(bytes) > static_cast<double>(spec_.queue_bytes)) {
    return std::nullopt;
  }
  const double taken_ns = static_cast<double>(bytes) * ns_per_byte;
  return busy_until_ = start + VirtualDuration::Nanoseconds(std::llround(taken_ns));
}

std::optional<VirtualTime> NetworkLink::Send(VirtualTime at, std::size_t bytes) {
  ++counts_.packets;
  counts_.bytes += bytes;
  // Every packet draws both numbers, whatever becomes of it.
  const double fate = random_.Uniform(), delay = random_.Uniform();
  const std::optional<VirtualTime> sent = Transmit(at, bytes);
  if (!sent) {
    ++counts_.dropped;
    return std::nullopt;
  }
  if (fate < spec_.loss) {
    ++counts_.lost;
    return std::nullopt;
  }
  const double jitter_ns = delay * static_cast<double>(spec_.jitter.ns());
  const VirtualDuration way =
      spec_.latency + VirtualDuration::Nanoseconds(static_cast<std::int64_t>(jitter_ns));
  return last_arrival_ = std::max(last_arrival_, *sent + way);
}

NetworkLink::Passage NetworkLink::SendMessage(VirtualTime at, std::size_t bytes) {
  Passage passage{.arrives = at + spec_.latency};
  do {
    const std::size_t part = std::min(bytes, kMostPayload);
    bytes -= part;
    if (const auto arrives = Send(at, part + kHeads)) {
      passage.arrives = *arrives;
    } else {
      passage.is_whole = false;
    }
  } while (bytes > 0);
  return passage;
}

bool NetworkLink::GetsThroughAgain(std::size_t bytes) {
  bool is_whole = true;
  for (std::size_t sent = 0; sent == 0 || sent < bytes; sent += kMostPayload) {
    if (random_.Uniform() >= spec_.loss) continue;
    ++counts_.lost;
    is_whole = false;
  }
  return is_whole;
}

}  // namespace tcs
