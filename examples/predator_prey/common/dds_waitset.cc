#include "examples/predator_prey/common/dds_waitset.h"

#include <algorithm>

namespace predator_prey {

Waitset::Waitset(const DdsEntity& participant)
    : waitset_(dds_create_waitset(participant.handle()), "make a waitset") {}

void Waitset::Attach(const DdsEntity& condition) {
  CheckDds(dds_waitset_attach(waitset_.handle(), condition.handle(), 0), "attach to a waitset");
}

void Waitset::Wait() { WaitFor(DDS_INFINITY); }

void Waitset::WaitUntil(std::chrono::steady_clock::time_point deadline) {
  const std::chrono::nanoseconds left = deadline - std::chrono::steady_clock::now();
  WaitFor(std::max<dds_duration_t>(left.count(), 0));
}

void Waitset::WaitFor(dds_duration_t at_most) {
  CheckDds(dds_waitset_wait(waitset_.handle(), nullptr, 0, at_most), "wait");
}

}  // namespace predator_prey
