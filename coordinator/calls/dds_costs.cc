#include "coordinator/calls/dds_costs.h"

#include <algorithm>
#include <cstddef>

#include "coordinator/scenario/scenario.h"

namespace tcs {

namespace {

// A cost of a call that somebody has set, or found by `tcsim fit`, is meant to be all that the
// client computes.
bool HasUsualCosts(const Process& process) {
  return process.call_cost == ClientSpec{}.fixed_call_cost && !process.allocation_cost.has_value();
}

}  // namespace

void DdsCosts::UseNetwork(Wire& wire) {
  network_.emplace(wire, [this](std::uint32_t process) { return RobotOf(process); });
}

// As the network counts robots: from 0 on. No robot has the number of none.
std::size_t DdsCosts::RobotOf(std::uint32_t process) const {
  const Process* of = process_of_(process);
  return of == nullptr ? SIZE_MAX : of->robot->number - 1;
}

VirtualDuration DdsCosts::Price(const Process& process, const shm::DdsMessage& header,
                                PriceBySize DdsPrices::*part) const {
  const PriceList& list = process.robot->prices;
  const bool is_reliable = (header.flags & shm::kDdsUnreliable) == 0;
  const VirtualDuration price = (list.Dds(is_reliable).*part).Of(header.payload_size);
  if (!counts_calls_ || !HasUsualCosts(process)) return price;
  return price + (list.dds_computed.*part).Of(header.payload_size);
}

bool DdsCosts::IsFurther(const shm::DdsMessage& header, std::uint32_t to) {
  Sent& last = last_[header.from];
  const dds::Guid writer = dds::GuidAt(header.subject);
  const bool is_same = writer == last.writer && header.source_timestamp_ns == last.timestamp_ns &&
                       std::ranges::find(last.to, to) == last.to.end();
  if (!is_same) last = {writer, header.source_timestamp_ns, {}};
  last.to.push_back(to);
  return is_same;
}

std::int64_t DdsCosts::ArrivalNs(const shm::DdsMessage& header, std::uint32_t to) {
  const Process* process = process_of_(header.from);
  if (process != nullptr && header.kind == shm::DdsKind::kSample) {
    for_sent_ += Price(*process, header,
                       IsFurther(header, to) ? &DdsPrices::send_further : &DdsPrices::send);
  }
  shm::DdsMessage leaving = header;
  leaving.time_ns += for_sent_.ns();
  return network_ ? network_->ArrivalNs(leaving, to) : leaving.time_ns;
}

std::int64_t DdsCosts::RoundTripNs(std::uint32_t one, std::uint32_t other) const {
  return network_ ? network_->RoundTripNs(one, other) : 0;
}

VirtualDuration DdsCosts::ForReceiving(const Process& process,
                                       const shm::DdsMessage& header) const {
  if (header.kind != shm::DdsKind::kSample) return {};
  return Price(process, header, &DdsPrices::receive);
}

}  // namespace tcs
