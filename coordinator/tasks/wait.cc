#include "coordinator/tasks/wait.h"

namespace tcs {

namespace {

template <class... Kinds>
bool IsOneOf(const Wait& wait) {
  return (... || std::holds_alternative<Kinds>(wait.what));
}

}  // namespace

bool LooksAtOthers(const Wait& wait) {
  return IsOneOf<awaited::Descriptors, awaited::Child, awaited::Queue, awaited::Signals,
                 awaited::Messages>(wait);
}

bool IsForInput(const Wait& wait) {
  return IsOneOf<awaited::Descriptors, awaited::Queue, awaited::Signals, awaited::Messages,
                 awaited::Room>(wait);
}

std::uint64_t SignalsThatEnd(const Wait& wait) {
  if (const auto* accepts = wait.As<awaited::Signals>()) return accepts->set;
  if (const auto* descriptors = wait.As<awaited::Descriptors>()) return descriptors->signals;
  return 0;
}

std::optional<std::uint64_t> MaskOf(const Wait& wait) {
  const auto* time = wait.As<awaited::Time>();
  return time == nullptr ? std::nullopt : time->mask;
}

void WaitCounts::Count(const Wait& wait, int by) {
  if (const auto* child = wait.As<awaited::Child>()) {
    for_child_ += by;
    if (child->stops) for_stops_ += by;
  }
  if (SignalsThatEnd(wait) != 0) for_signals_ += by;
  if (wait.As<awaited::Room>() != nullptr) for_room_ += by;
  if (wait.As<awaited::Deliverer>() != nullptr) for_deliverer_ += by;
  const auto* descriptors = wait.As<awaited::Descriptors>();
  if (wait.As<awaited::Queue>() != nullptr ||
      (descriptors != nullptr && descriptors->has_terminal)) {
    for_objects_ += by;
  }
}

}  // namespace tcs
