#include "coordinator/network/dds_paths.h"

#include <algorithm>

namespace tcs {

namespace {

constexpr int kMostTries = 1000;

}  // namespace

bool DdsPaths::AreApart(std::size_t from, std::size_t to) const {
  return from != to && from < wire_.robots() && to < wire_.robots();
}

std::int64_t DdsPaths::RoundTripNs(std::uint32_t one, std::uint32_t other) const {
  const std::size_t from = robot_of_(one), to = robot_of_(other);
  return AreApart(from, to) ? wire_.RoundTrip(from, to).ns() : 0;
}

VirtualTime DdsPaths::SendAgain(NetworkLink& link, std::size_t bytes, VirtualTime arrives,
                                VirtualDuration round_trip) {
  for (int tries = 0; tries < kMostTries; ++tries) {
    arrives += round_trip;
    if (link.GetsThroughAgain(bytes)) return arrives;
  }
  return VirtualTime::Never();
}

std::int64_t DdsPaths::ArrivalNs(const shm::DdsMessage& header, std::uint32_t to) {
  const std::size_t from_robot = robot_of_(header.from), to_robot = robot_of_(to);
  if (!AreApart(from_robot, to_robot)) return header.time_ns;
  NetworkLink& link = wire_.Between(from_robot, to_robot);
  const NetworkLink::Passage passage =
      link.SendMessage(VirtualTime::FromNanoseconds(header.time_ns), header.size);
  const bool is_sample = header.kind == shm::DdsKind::kSample;
  Last& last = last_[{header.from, to}];
  VirtualTime arrives = passage.arrives;
  if (is_sample && (header.flags & shm::kDdsUnreliable) != 0) {
    return (passage.is_whole ? std::max(arrives, last.news) : VirtualTime::Never()).ns();
  }
  if (!passage.is_whole) {
    arrives = SendAgain(link, header.size, arrives, wire_.RoundTrip(from_robot, to_robot));
  }
  if (arrives.IsNever()) return arrives.ns();
  last.reliable = arrives = std::max(arrives, last.reliable);
  if (!is_sample) last.news = arrives;
  return arrives.ns();
}

}  // namespace tcs
