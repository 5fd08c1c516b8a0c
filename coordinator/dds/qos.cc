#include "coordinator/dds/qos.h"

namespace tcs::dds {
namespace {

bool IsShorter(const std::optional<VirtualDuration>& a, const std::optional<VirtualDuration>& b) {
  return a && (!b || *a < *b);
}

template <class Kind>
std::string Wants(Kind wanted, Kind offered) {
  return "wants " + NameOf(wanted) + ", but is offered " + NameOf(offered);
}

}  // namespace

std::string NameOf(Reliability reliability) {
  return reliability == Reliability::kReliable ? "reliable" : "best_effort";
}

std::string NameOf(History history) {
  return history == History::kKeepLast ? "keep_last" : "keep_all";
}

std::string NameOf(Durability durability) {
  return durability == Durability::kVolatile ? "volatile" : "transient_local";
}

std::string NameOf(Liveliness liveliness) {
  switch (liveliness) {
    case Liveliness::kManualByParticipant:
      return "manual_by_participant";
    case Liveliness::kManualByTopic:
      return "manual_by_topic";
    default:
      return "automatic";
  }
}

std::optional<std::string> WhatDoesNotMatch(const Qos& wanted, const Qos& offered) {
  if (wanted.reliability == Reliability::kReliable && offered.reliability != wanted.reliability) {
    return Wants(wanted.reliability, offered.reliability);
  }
  if (wanted.durability == Durability::kTransientLocal && offered.durability != wanted.durability) {
    return Wants(wanted.durability, offered.durability);
  }
  // From the weakest promise to the strongest.
  if (offered.liveliness < wanted.liveliness) return Wants(wanted.liveliness, offered.liveliness);
  if (IsShorter(wanted.deadline, offered.deadline))
    return "requests a shorter deadline than is offered";
  if (IsShorter(wanted.lease, offered.lease)) {
    return "requests a shorter liveliness lease than is offered";
  }
  return std::nullopt;
}

}  // namespace tcs::dds
