// The quality of service of one DDS endpoint: as a scenario asks for it, as a recording says that
// it was offered, as `tcsim topics` shows it. The policies that ROS 2 knows, with its defaults.
#pragma once

#include <optional>
#include <string>

#include "shm/virtual_time.h"

namespace tcs::dds {

enum class Reliability { kReliable, kBestEffort };
enum class History { kKeepLast, kKeepAll };
enum class Durability { kVolatile, kTransientLocal };
enum class Liveliness { kAutomatic, kManualByParticipant, kManualByTopic };

struct Qos {
  Reliability reliability = Reliability::kReliable;
  History history = History::kKeepLast;
  int depth = 10;  // of kKeepLast, at least 1
  Durability durability = Durability::kVolatile;
  Liveliness liveliness = Liveliness::kAutomatic;
  // None: infinite.
  std::optional<VirtualDuration> deadline;
  std::optional<VirtualDuration> lifespan;  // a writer's
  std::optional<VirtualDuration> lease;     // of the liveliness

  friend bool operator==(const Qos&, const Qos&) = default;
};

// The names in scenarios and results: "best_effort", "keep_last", "transient_local".
[[nodiscard]] std::string NameOf(Reliability reliability);
[[nodiscard]] std::string NameOf(History history);
[[nodiscard]] std::string NameOf(Durability durability);
[[nodiscard]] std::string NameOf(Liveliness liveliness);

// Why a reader that asks for `wanted` gets nothing of a writer that offers `offered`, as the rest
// of a sentence about the reader; none if they match. DDS's own rules.
[[nodiscard]] std::optional<std::string> WhatDoesNotMatch(const Qos& wanted, const Qos& offered);

}  // namespace tcs::dds
