#include "coordinator/dds/qos.h"

namespace tcs::dds {

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

}  // namespace tcs::dds
