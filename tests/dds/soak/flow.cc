#include "tests/dds/soak/flow.h"

#include <array>
#include <bit>
#include <vector>

namespace dds_soak {
namespace {

Qos All() { return Qos().Reliable().KeepAll(); }

// Xorshift's.
std::vector<std::uint8_t> Noise(std::size_t size) {
  std::vector<std::uint8_t> bytes(size);
  std::uint64_t state = 88172645463325252u;
  for (std::uint8_t& byte : bytes) {
    state ^= state << 13;
    state ^= state >> 7;
    state ^= state << 17;
    byte = static_cast<std::uint8_t>(state >> 24);
  }
  return bytes;
}

}  // namespace

std::span<const Flow> Flows() {
  static const std::array events{
      ReadBy{.process = 0, .promise = Promise::kAll, .qos = All()},
      ReadBy{.process = 1, .promise = Promise::kOrder, .qos = Qos().BestEffort().KeepLast(8)},
      ReadBy{.process = 2, .promise = Promise::kAll, .qos = All(), .listens = true},
  };
  static const std::array blocks{
      ReadBy{.process = 2, .promise = Promise::kAll, .qos = All()},
      ReadBy{.process = 3, .promise = Promise::kAll, .qos = All().AtMost(64)},
  };
  static const std::array states{
      ReadBy{.process = 1, .promise = Promise::kLast, .qos = Qos().Reliable().KeepLast(4)},
      ReadBy{.process = 3, .promise = Promise::kLast, .qos = Qos().Reliable().KeepLast(1)},
  };
  static const std::array sensors{
      ReadBy{.process = 0, .promise = Promise::kOrder, .qos = Qos().BestEffort().KeepLast(4)},
      ReadBy{.process = 3, .promise = Promise::kOrder, .qos = Qos().BestEffort().KeepAll()},
  };
  static const std::array latched{
      ReadBy{.process = 0, .promise = Promise::kAll, .qos = All().TransientLocal()},
      ReadBy{.process = 1,
             .promise = Promise::kAll,
             .qos = All().TransientLocal(),
             .comes_late = true},
  };
  static const std::array flows{
      Flow{.name = "events",
           .writer_qos = All(),
           .written_by = 0b1111,
           .readers = events,
           .share = 0.6,
           .keys = 16,
           .own_keys = false,
           .least_bytes = 16,
           .most_bytes = 64,
           .at_once = 0,
           .pause = 0,
           .disposes_every = 997},
      Flow{.name = "blocks",
           .writer_qos = All(),
           .written_by = 0b0011,
           .readers = blocks,
           .share = 0.05,
           .keys = 3,
           .own_keys = false,
           .least_bytes = 1000,
           .most_bytes = 16000,
           .at_once = 0,
           .pause = 0,
           .disposes_every = 0},
      Flow{.name = "states",
           .writer_qos = Qos().Reliable().KeepLast(1),
           .written_by = 0b1111,
           .readers = states,
           .share = 0.2,
           .keys = 64,
           .own_keys = true,
           .least_bytes = 0,
           .most_bytes = 200,
           .at_once = 50,
           .pause = DDS_MSECS(1),
           .disposes_every = 331},
      Flow{.name = "sensors",
           .writer_qos = Qos().BestEffort().KeepLast(1),
           .written_by = 0b0110,
           .readers = sensors,
           .share = 0.1,
           .keys = 4,
           .own_keys = true,
           .least_bytes = 100,
           .most_bytes = 700,
           .at_once = 5,
           .pause = DDS_USECS(200),
           .disposes_every = 0},
      Flow{.name = "latched",
           .writer_qos = All().TransientLocal(),
           .written_by = 0b1100,
           .readers = latched,
           .share = 0.05,
           .keys = 100,
           .own_keys = false,
           .least_bytes = 8,
           .most_bytes = 80,
           .at_once = 20,
           .pause = DDS_MSECS(1),
           .disposes_every = 0},
  };
  return flows;
}

std::uint32_t SamplesOfEach(const Flow& flow, std::uint64_t total) {
  const auto writers = std::popcount(flow.written_by);
  return static_cast<std::uint32_t>(flow.share * static_cast<double>(total) / writers);
}

std::span<const std::uint8_t> PayloadOf(const Flow& flow, int writer, std::uint32_t number) {
  constexpr std::size_t kNoise = 1 << 16;
  static const std::vector<std::uint8_t> noise = Noise(kNoise);
  const std::uint32_t mixed = (number * 4u + static_cast<std::uint32_t>(writer)) * 2654435761u;
  const std::uint32_t size =
      flow.least_bytes + (mixed >> 8) % (flow.most_bytes - flow.least_bytes + 1);
  const std::size_t at = mixed % (kNoise - flow.most_bytes);
  return std::span(noise).subspan(at, size);
}

}  // namespace dds_soak
