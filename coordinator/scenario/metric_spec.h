// The metrics that a scenario names, as it describes them: plain values, already checked.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "coordinator/metrics/expression.h"
#include "coordinator/metrics/metric_figures.h"
#include "shm/virtual_time.h"

namespace tcs {

// What there is to know of how a body or a link moves, in the world's frame; SI units.
inline constexpr std::array<std::string_view, 12> kMotionQuantities = {
    "x", "y", "z", "vx", "vy", "vz", "wx", "wy", "wz", "roll", "pitch", "yaw"};

// A number of the world, or of what goes over a channel.
struct QuantitySpec {
  enum class Kind { kBody, kLink, kJoint, kReading, kCommand };
  Kind kind = Kind::kBody;
  // Of the body, link or joint, as Dynamics numbers them; of the sensor or the channel of commands,
  // in the scenario's lists.
  std::size_t index = 0;
  // Which of kMotionQuantities or kJointQuantities it is; of a reading, which component.
  std::size_t part = 0;
  // Of a reading and a command: what it is of (a body, a joint, a rotor; empty: there is but one
  // such thing), and which field.
  std::string of{}, field{};
};

struct MetricSpec {
  std::string name;
  MetricFigure asked = MetricFigure::kLast;
  Expression expression;  // of Scenario::quantities; a condition if that is asked for
  VirtualDuration from{};
  std::optional<VirtualDuration> until{};  // both included
  VirtualDuration every{};                 // 0: Scenario::csv_period
  // Of what is expected: between what it is to stay. The first time is that of the first value
  // that is not.
  std::optional<double> least{}, most{};
};

}  // namespace tcs
